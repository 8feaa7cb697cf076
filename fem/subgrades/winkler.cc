// A bed of independent vertical springs.
#include "fem/point_bed.h"
#include "fem/subgrades/registry.h"

namespace trackbed::fem {
namespace {

std::unique_ptr<Structure> build(const SubgradeSite& site, const Values& values) {
  PointBedParameters p = points_under(site);
  p.stiffness = number(values, "Modulus of reaction");
  p.mass = number(values, "Mass");
  return make_point_bed(p);
}

const double kMost = std::numeric_limits<double>::infinity();
const std::string kSection = "Subgrade/winkler";

const RegisterSubgrade here{
    {"winkler",
     "Independent vertical springs, p = k u (Winkler 1867): pressure p, settlement u, modulus of "
     "subgrade "
     "reaction k from a plate load test. The cheapest subgrade; it does not spread a load.",
     {{kSection,
       "Modulus of reaction",
       "100e6",
       "N/m3",
       "modulus of subgrade reaction k",
       ParameterKind::number,
       1,
       kMost,
       {}},
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
