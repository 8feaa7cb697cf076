#include "apps/trackbed/check_packing.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/grain_estimate.h"
#include "apps/trackbed/simulation/quasi_vibration.h"
#include "apps/trackbed/simulation/zones.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

struct Check {
  const Scene& scene;
  const ParameterValues& values;

  [[noreturn]] void refuse(const std::string& key, const std::string& why) const {
    values.refuse("Packing/" + key, why);
  }
};

void check_quasi_vibration(const Check& c) {
  const PackingScene& p = c.scene.packing;
  if (p.method != "quasi_vibration") {
    if (p.target_porosity >= 0)
      c.refuse("Target porosity", "needs Packing/Method = quasi_vibration, not " + p.method);
    return;
  }
  if (p.packing_friction >= 0)
    c.refuse("Packing friction", "quasi_vibration takes its frictions from Packing/Friction path");
  try {
    dem::validate(path_settings(c.scene));
  } catch (const InputError& e) {
    c.refuse("Friction path", e.what());
  }
}

void check_copies(const Check& c) {
  const PackingScene& p = c.scene.packing;
  const ContainerScene& box = c.scene.container;
  double largest = 0;
  for (const auto& k : gradation_classes(c.scene)) largest = std::max(largest, k.upper);
  if (p.layers > 1 && box.depth / p.layers < 2 * largest)
    c.refuse("Layers", "a layer would be " + shortest(box.depth / p.layers) +
                           " m high; at least two of the largest grains (" + shortest(largest) +
                           " m), so at most " +
                           std::to_string(std::max(1, static_cast<int>(box.depth / largest / 2))));
  if (p.bays > 1 && !box.periodic) c.refuse("Bays", "needs Container/Periodic along track = true");
  if (p.bays > 1 && box.width / p.bays < 3 * largest)
    c.refuse("Bays", "a bay would be " + shortest(box.width / p.bays) +
                         " m long; at least three of the largest grains (" + shortest(largest) +
                         " m)");
}

void check_cylinder(const Check& c) {
  const ContainerScene& box = c.scene.container;
  if (box.shape != "cylinder") return;
  const auto refuse = [&](const std::string& path, const std::string& why) {
    throw InputError(c.values.where(path) + " = " + c.values.text(path) + ": " + why);
  };
  if (box.width != box.length)
    refuse("Container/Width", "a cylinder's Width and Length are both its diameter; Length is " +
                                  shortest(box.length) + " m");
  if (box.periodic) refuse("Container/Periodic along track", "a cylinder has no seam");
  if (box.half) refuse("Container/Half by symmetry", "a cylinder is computed whole");
  if (box.shoulder_width > 0) refuse("Container/Shoulder width", "a cylinder has no shoulders");
  if (box.sides % 4 != 0) refuse("Container/Sides", "a multiple of four is needed");
  const double across = std::hypot(c.scene.sleeper.length, c.scene.sleeper.width);
  if (across > 0.998 * box.length)
    refuse("Sleeper/Length", "the sleeper is " + shortest(across) +
                                 " m from corner to corner, wider than the cylinder");
}

void check_zones(const Check& c) {
  const ZoneScene& z = c.scene.zones;
  if (!z.use) return;
  const auto refuse = [&](const std::string& path, const std::string& why) {
    throw InputError(c.values.where(path) + " = " + c.values.text(path) + ": " + why);
  };
  if (c.scene.container.shape != "box") refuse("Zones/Use", "zones need Container/Shape = box");
  if (!c.scene.packing.start_from.empty())
    refuse("Zones/Use", "the grains come from Packing/Start from");
  if (c.scene.packing.layers * c.scene.packing.bays > 1)
    refuse("Zones/Use", "zones cannot be had together with Packing/Layers or Packing/Bays");
  const auto zones = make_zones(c.scene, make_layout(c.scene), false);
  if (zones[2].area < 1e-9)
    refuse("Zones/Margin", "nothing of the box is left outside the fine zone and its transition");
  double largest = 0;
  for (const auto& k : gradation_classes(coarse_scene(c.scene)))
    largest = std::max(largest, k.upper);
  if (largest > 0.5 * c.scene.container.depth)
    refuse(z.curve == "scaled" ? "Zones/Size ratio" : "Zones/Curve",
           "the largest coarse grains (" + shortest(largest) +
               " m) must be at most half of the bed's depth");
}

}  // namespace

void check_packing(const Scene& scene, const ParameterValues& values) {
  const Check check{scene, values};
  check_cylinder(check);
  check_zones(check);
  check_quasi_vibration(check);
  check_copies(check);
  const ReplayScene& replay = scene.replay;
  if (!replay.bodies.empty() && !std::filesystem::is_regular_file(replay.bodies))
    throw InputError(values.where("Replay/Bodies") + " = " + replay.bodies +
                     ": no such file (looked for next to the scene's file)");
  if (!replay.bodies.empty() && scene.numerics.time_step == 0)
    throw InputError(values.where("Replay/Bodies") + ": a replay needs Numerics/Time step");
  const std::string& start = scene.packing.start_from;
  if (!start.empty() && !std::filesystem::is_regular_file(start))
    check.refuse("Start from", "no such file (looked for next to the scene's file)");
  if (scene.packing.origin.size() != 3) check.refuse("Origin", "three numbers are needed: x, y, z");
}

}  // namespace trackbed::apps
