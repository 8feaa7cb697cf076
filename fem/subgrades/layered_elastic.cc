// Horizontal layers of linear elastic soil on a fixed base.
#include <sstream>

#include "base/error.h"
#include "fem/subgrades/registry.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

std::unique_ptr<Structure> build(const SubgradeSite& site, const Values& values) {
  ElasticBodyParameters p = box_under(site);
  std::stringstream list(values.at("Layers"));
  for (std::string one; std::getline(list, one, ',');) {
    std::stringstream row(one);
    double thickness = 0;
    Material m;
    char c[3] = {};
    row >> thickness >> c[0] >> m.young >> c[1] >> m.poisson >> c[2] >> m.density;
    std::string rest;
    if (!row || c[0] != ':' || c[1] != ':' || c[2] != ':' || (row >> rest))
      throw InputError(text("Subgrade/layered_elastic/Layers: '", one,
                            "' is not thickness:E:nu:density (m, Pa, -, kg/m3)"));
    m.name = text("layer ", p.materials.size() + 1);
    // Written from the top down, meshed from the bottom up.
    p.mesh.layers.insert(p.mesh.layers.begin(),
                         Layer{thickness, thickness > 0 ? cells_over(site, thickness) : 1,
                               static_cast<int>(p.materials.size())});
    p.materials.push_back(m);
    p.mesh.corner[2] -= thickness;
  }
  if (p.materials.empty()) throw InputError("Subgrade/layered_elastic/Layers: no layer given");
  p.mesh.file = values.at("Mesh");
  if (!p.mesh.file.empty()) {
    p.mesh.corner = {0, 0, site.top};
    if (p.materials.size() > 1)
      for (std::size_t k = 0; k < p.materials.size(); ++k)
        p.mesh.region_material[text("layer_", k + 1)] = static_cast<int>(k);
  }
  return make_body(site, std::move(p));
}

const RegisterSubgrade here{
    {"layered_elastic",
     "Linear elastic layers, σ = λ tr(ε) I + 2μ ε with λ = Eν/((1+ν)(1−2ν)), μ = E/(2(1+ν)) in "
     "each. "
     "For moduli measured layer by layer (plate load test, resilient modulus).",
     {{"Subgrade/layered_elastic",
       "Layers",
       "0.2:120e6:0.3:2000, 0.4:60e6:0.35:1900",
       "m:Pa:-:kg/m3",
       "layers from the top down, each thickness:E:nu:density",
       ParameterKind::text,
       {},
       {},
       {}},
      {"Subgrade/layered_elastic",
       "Mesh",
       "",
       "-",
       "Gmsh file instead of a box, its top at z = 0, relative to this file; its physical volumes "
       "are layer_1, layer_2, ... from the top down, thicknesses are then not used",
       ParameterKind::text,
       {},
       {},
       {}}},
     build}};

}  // namespace
}  // namespace trackbed::fem
