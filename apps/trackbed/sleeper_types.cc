#include "apps/trackbed/sleeper_types.h"

#include <algorithm>

#include "apps/trackbed/csv.h"

namespace trackbed::apps {
namespace {

// A block with the base and the height at the rail seats of the real sleeper, and a density that
// gives its mass; the real one's sides lean inwards and its middle is lower.
//
// Found on web pages that quote no drawing (zkxblog.com/lab/read-5185893.html for type II,
// wapiknow.baidu.com/question/762775067153312204.html for type III):
//   chinese_II   the new type II: 2.5 m long, 0.205 m high at the seats (0.175 m in the middle),
//                0.3065 m at its widest, 283 kg
//   chinese_III  2.6 m long, 0.23 m high at the seats (0.185 m in the middle), 353 kg
// From who makes it: B70 weighs 280 kg (weckenmann.de, 1 February 2018, on RAIL.ONE's plant in
// Coswig). Commonly quoted and unchecked: the base of chinese_III, 0.32 m at the ends; of B70 the
// length, 2.6 m, the base, 0.30 m, and the height at the seats, 0.21 m (size as
// meshes/sleeper_b70.geo).
// Modulus: C60 of GB 50010, 36 GPa; B70's concrete is C50/60 (cubes of
// 60 N/mm2: tkgftgleistechnik.de, Oberbauhandbuch, sheet 222-01), 37 GPa (EN 1992-1-1, Table 3.1).
// Seats: 1.435 m gauge and half a rail head on each side, 1.507 m from rail to rail.
struct Type {
  const char* name;
  double length, width, height, mass, modulus;
};

constexpr Type kTypes[] = {{"chinese_II", 2.5, 0.3065, 0.205, 283, 3.6e10},
                           {"chinese_III", 2.6, 0.32, 0.23, 353, 3.6e10},
                           {"B70", 2.6, 0.30, 0.21, 280, 3.7e10}};

}  // namespace

std::vector<std::string> sleeper_types() {
  std::vector<std::string> names{"block"};
  for (const Type& t : kTypes) names.push_back(t.name);
  return names;
}

void apply_sleeper_type(std::vector<SceneEntry>& entries) {
  const SceneEntry* chosen = nullptr;
  for (const SceneEntry& e : entries)
    if (e.path() == "Sleeper/Type") chosen = &e;
  if (!chosen) return;
  const auto type = std::find_if(std::begin(kTypes), std::end(kTypes),
                                 [&](const Type& t) { return chosen->value == t.name; });
  if (type == std::end(kTypes)) return;  // block, or refused with the names there are
  const SceneEntry place = *chosen;
  const auto set = [&](const char* key, const std::string& value) {
    const bool given = std::any_of(entries.begin(), entries.end(), [&](const SceneEntry& e) {
      return e.section == "Sleeper" && e.key == key;
    });
    if (!given) entries.push_back({"Sleeper", key, value, place.file, place.line});
  };
  set("Length", shortest(type->length));
  set("Width", shortest(type->width));
  set("Height", shortest(type->height));
  set("Density", shortest(type->mass / (type->length * type->width * type->height)));
  set("Modulus", shortest(type->modulus));
  set("Poisson", "0.2");
  set("Seats", "-0.7535, 0.7535");
  set("Elements", "26, 3, 2");
}

}  // namespace trackbed::apps
