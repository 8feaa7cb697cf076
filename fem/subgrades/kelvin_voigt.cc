// A bed of independent vertical springs and dashpots.
#include "fem/point_bed.h"
#include "fem/subgrades/registry.h"

namespace trackbed::fem {
namespace {

std::unique_ptr<Structure> build(const SubgradeSite& site, const Values& values) {
  PointBedParameters p = points_under(site);
  p.stiffness = number(values, "Modulus of reaction");
  p.dashpot = number(values, "Dashpot");
  p.mass = number(values, "Mass");
  return make_point_bed(p);
}

const double kMost = std::numeric_limits<double>::infinity();
const std::string kSection = "Subgrade/kelvin_voigt";

const RegisterSubgrade here{
    {"kelvin_voigt",
     "Independent vertical springs beside dashpots, p = k u + c du/dt (Kelvin, Voigt): pressure p, "
     "settlement u. Adds the soil's damping to `winkler`.",
     {{kSection,
       "Modulus of reaction",
       "100e6",
       "N/m3",
       "spring k",
       ParameterKind::number,
       1,
       kMost,
       {}},
      {kSection, "Dashpot", "2e5", "N s/m3", "dashpot c", ParameterKind::number, 0, kMost, {}},
      {kSection,
       "Mass",
       "400",
       "kg/m2",
       "soil that moves along, per area",
       ParameterKind::number,
       1e-3,
       kMost,
       {}}},
     build}};

}  // namespace
}  // namespace trackbed::fem
