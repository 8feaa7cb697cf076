// Linear elastic soil whose modulus grows with depth (Gibson soil).
#include "fem/subgrades/registry.h"

namespace trackbed::fem {
namespace {

std::unique_ptr<Structure> build(const SubgradeSite& site, const Values& values) {
  ElasticBodyParameters p = box_under(site);
  const double depth = number(values, "Depth");
  Material soil;
  soil.name = "soil";
  soil.model = depth_elastic("Subgrade/depth_elastic", number(values, "Modulus at top"),
                             number(values, "Growth of modulus"), number(values, "Poisson ratio"),
                             number(values, "Density"));
  p.materials = {soil};
  p.mesh.layers = {{depth, cells_over(site, depth), 0}};
  p.mesh.corner[2] -= depth;
  return make_body(site, std::move(p));
}

const double kMost = std::numeric_limits<double>::infinity();
const std::string kSection = "Subgrade/depth_elastic";

const RegisterSubgrade here{
    {"depth_elastic",
     "Linear elastic soil with E(z) = E_top + g z, z the depth below its surface (Gibson 1967). "
     "For sand "
     "and deep uniform clay, where stiffness comes with confinement.",
     {{kSection,
       "Depth",
       "1",
       "m",
       "thickness of the soil over a fixed base",
       ParameterKind::number,
       1e-3,
       100,
       {}},
      {kSection,
       "Modulus at top",
       "40e6",
       "Pa",
       "Young's modulus at the surface E_top",
       ParameterKind::number,
       1,
       kMost,
       {}},
      {kSection,
       "Growth of modulus",
       "20e6",
       "Pa/m",
       "growth of Young's modulus with depth g",
       ParameterKind::number,
       0,
       kMost,
       {}},
      {kSection,
       "Poisson ratio",
       "0.3",
       "-",
       "Poisson's ratio",
       ParameterKind::number,
       -0.99,
       0.4999,
       {}},
      {kSection, "Density", "1900", "kg/m3", "density", ParameterKind::number, 1, 1e5, {}}},
     build}};

}  // namespace
}  // namespace trackbed::fem
