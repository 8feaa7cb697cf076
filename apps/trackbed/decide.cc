#include "apps/trackbed/decide.h"

#include <cmath>
#include <cstdio>

#include "apps/trackbed/simulation/grains.h"
#include "fem/bending.h"

namespace trackbed::apps {
namespace {

constexpr double stiffest_bed = 2e8;  // [Pa]
constexpr double bed_poisson = 0.2;

void decide_sleeper(Scene& scene) {
  SleeperScene& s = scene.sleeper;
  if (s.model != "auto") return;
  const double bending = s.modulus * s.width * std::pow(s.height, 3) / 12;
  const double bed = fem::vesic_bed(stiffest_bed, bed_poisson, s.width, bending);
  const double ratio = fem::beam_length_ratio(bed, bending, s.length);
  s.model = ratio < fem::kShortBeam ? "rigid" : "elastic";
  scene.values["Sleeper/Model"] = s.model;
  char why[200];
  std::snprintf(why, sizeof why,
                "Sleeper/Model = auto: %s, its length ratio on the stiffest bed is %.2f (a beam "
                "bends from %.2f on)",
                s.model.c_str(), ratio, fem::kShortBeam);
  scene.decisions.push_back(why);
}

}  // namespace

bool stores_energy(const Scene& scene) {
  const bool polyhedra = has_shape(scene, "polyhedron") || !scene.packing.start_from.empty();
  return scene.contact.law != "shao2017" || !polyhedra;
}

void decide(Scene& scene) {
  decide_sleeper(scene);
  if (!stores_energy(scene))
    scene.decisions.push_back(
        "Numerics/Closure = " + scene.values.at("Numerics/Closure") +
        ": held by what the exchange and the structures make, not by the ledger as a whole, for "
        "Contact/Law = shao2017 stores no energy");
}

}  // namespace trackbed::apps
