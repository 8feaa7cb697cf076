#include "apps/trackbed/check_structures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/mesh_names.h"
#include "apps/trackbed/parameter_text.h"
#include "apps/trackbed/simulation/structures.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

[[noreturn]] void refuse(const ParameterValues& values, const std::string& path,
                         const std::string& why) {
  throw InputError(values.where(path) + " = " + values.text(path) + ": " + why);
}

/// The boundaries are those of a block: each is held, loaded or touched by grains.
void check_mesh(const ParameterValues& values, const std::string& path) {
  const std::string& mesh = values.text(path);
  if (mesh.empty()) return;
  if (!std::filesystem::is_regular_file(mesh))
    refuse(values, path, "no such file (a mesh is looked for next to the scene's file)");
  const auto names = physical_surfaces(mesh);
  for (const char* needed : {"bottom", "top", "x_min", "x_max", "y_min", "y_max"})
    if (std::find(names.begin(), names.end(), needed) == names.end())
      refuse(values, path,
             std::string("has no physical surface '") + needed +
                 "'; needed are bottom, top, x_min, x_max, y_min and y_max, the file has " +
                 (names.empty() ? "none" : join_names(names)));
}

/// A structure's words name the parameter by its path; where it was given comes before them.
[[noreturn]] void refuse_with_place(const ParameterValues& values, const std::string& fallback,
                                    const std::string& why) {
  std::string path;
  for (const auto& entry : values.all())
    if (entry.first.size() > path.size() && why.rfind(entry.first, 0) == 0) path = entry.first;
  if (path.empty()) refuse(values, fallback, why);
  throw InputError(values.where(path) + why.substr(path.size()));
}

/// Extent of the contact surface [m]: low x, high x, low y, high y, low z, high z.
std::array<double, 6> extent(const fem::Structure& structure) {
  std::array<double, 6> e{1e300, -1e300, 1e300, -1e300, 1e300, -1e300};
  for (const auto& node : structure.surface().nodes)
    for (int k = 0; k < 3; ++k) {
      e[2 * k] = std::min(e[2 * k], node[k]);
      e[2 * k + 1] = std::max(e[2 * k + 1], node[k]);
    }
  return e;
}

std::string span(double low, double high) {
  const auto text = [](double x) { return shortest(std::round(x * 1e6) / 1e6); };
  return text(low) + " to " + text(high) + " m";
}

bool differs(double a, double b, double size) { return std::abs(a - b) > 1e-3 * size; }

void check_subgrade(const Scene& scene, const ParameterValues& values) {
  if (scene.subgrade.model == "rigid") return;
  const std::string section = "Subgrade/" + scene.subgrade.model;
  const bool has_mesh = scene.subgrade.values.count("Mesh") > 0;
  if (has_mesh) check_mesh(values, section + "/Mesh");
  Scene coarse = scene;
  const Layout l = make_layout(scene);
  const double length = l.high.x() - l.low.x(), width = l.high.y() - l.low.y();
  coarse.subgrade.element_size =
      std::max(scene.subgrade.element_size, 0.25 * std::min(length, width));
  std::array<double, 6> e;
  try {
    e = extent(*make_subgrade_structure(coarse, l));
  } catch (const InputError& error) {
    refuse_with_place(values, "Subgrade/Model", error.what());
  }
  if (differs(e[0], l.low.x(), length) || differs(e[1], l.high.x(), length) ||
      differs(e[2], l.low.y(), width) || differs(e[3], l.high.y(), width))
    refuse(values, has_mesh ? section + "/Mesh" : "Subgrade/Model",
           "its top spans " + span(e[0], e[1]) + " in x and " + span(e[2], e[3]) +
               " in y, the container " + span(l.low.x(), l.high.x()) + " and " +
               span(l.low.y(), l.high.y()));
}

void check_sleeper_mesh(const Scene& scene, const ParameterValues& values) {
  const SleeperScene& s = scene.sleeper;
  if (s.mesh.empty() || s.model == "rigid") return;
  check_mesh(values, "Sleeper/Mesh");
  const Layout l = make_layout(scene);
  std::array<double, 6> e;
  try {
    e = extent(*make_elastic_sleeper(scene, l, 0));
  } catch (const InputError& error) {
    refuse_with_place(values, "Sleeper/Mesh", error.what());
  }
  if (differs(e[0], l.sleeper_low_x, s.length) || differs(e[1], l.sleeper_high_x, s.length))
    refuse(values, "Sleeper/Mesh",
           "spans " + span(e[0], e[1]) + " in x; Sleeper/Length = " + shortest(s.length) +
               " m asks for " + span(l.sleeper_low_x, l.sleeper_high_x));
  if (differs(e[2], l.sleeper_low_y, s.width) || differs(e[3], l.sleeper_high_y, s.width))
    refuse(values, "Sleeper/Mesh",
           "spans " + span(e[2], e[3]) + " in y; Sleeper/Width = " + shortest(s.width) +
               " m asks for " + span(l.sleeper_low_y, l.sleeper_high_y));
  if (differs(e[4], 0, s.height))
    refuse(values, "Sleeper/Mesh",
           "its lowest point is at z = " + shortest(e[4]) + " m; the base must be at z = 0");
}

}  // namespace

void check_structures(const Scene& scene, const ParameterValues& values) {
  check_subgrade(scene, values);
  check_sleeper_mesh(scene, values);
}

}  // namespace trackbed::apps
