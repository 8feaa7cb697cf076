#include "apps/trackbed/simulation/materials.h"

#include <sstream>
#include <vector>

#include "apps/trackbed/parameter_text.h"
#include "base/error.h"
#include "dem/contact/restitution.h"

namespace trackbed::apps {
namespace {

// In the order of Material; coarse grains (Zones) are grains.
const std::vector<std::string> kNames{"grain", "grain",   "wall",    "mirror",
                                      "plate", "sleeper", "subgrade"};
const std::vector<std::string> kNamed{"grain", "wall", "mirror", "plate", "sleeper", "subgrade"};

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("Contact/Pairs: " + what +
                   "; expected such as grain-wall: friction 0.3, restitution 0.4; grain-sleeper: "
                   "modulus 1e9");
}

std::vector<std::string> pieces(const std::string& text, char at) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string piece; std::getline(in, piece, at);)
    if (!trimmed(piece).empty()) out.push_back(trimmed(piece));
  return out;
}

std::vector<int> materials_named(const std::string& name) {
  std::vector<int> found;
  for (int m = 0; m < kMaterials; ++m)
    if (kNames[m] == name) found.push_back(m);
  if (found.empty()) refuse("there is no material '" + name + "' (" + join_names(kNamed) + ")");
  return found;
}

void change(dem::PairMaterial& m, const std::string& setting, const Scene& s, double softness) {
  const auto space = setting.find_first_of(" \t");
  double value = 0;
  if (space == std::string::npos || !parse_number(trimmed(setting.substr(space)), value))
    refuse("'" + setting + "' is not a name and a number");
  const std::string name = setting.substr(0, space);
  if (name == "modulus" && value > 0)
    m.modulus = softness * value;
  else if (name == "friction" && value >= 0)
    m.friction = value;
  else if (name == "ratio" && value >= 0)
    m.tangential_ratio = value;
  else if (name == "restitution" && value >= 0.01 && value <= 1)
    m.damping = dem::damping_for_restitution(s.contact.round_law, value);
  else if (name == "stiffness" && value > 0)
    m.stiffness = value;
  else
    refuse("'" + setting + "' is no value of a pair: modulus, stiffness (positive), friction, " +
           "ratio (not negative), restitution (0.01 to 1)");
}

void apply_pairs(const Scene& s, double softness, dem::PairMaterials& table) {
  for (const std::string& entry : pieces(s.contact.pairs, ';')) {
    const auto colon = entry.find(':'), dash = entry.find('-');
    if (colon == std::string::npos || dash == std::string::npos || dash > colon)
      refuse("'" + entry + "' does not name two materials");
    const auto settings = pieces(entry.substr(colon + 1), ',');
    for (const int i : materials_named(trimmed(entry.substr(0, dash))))
      for (const int j : materials_named(trimmed(entry.substr(dash + 1, colon - dash - 1)))) {
        dem::PairMaterial m = table(i, j);
        for (const std::string& setting : settings) change(m, setting, s, softness);
        table.set(i, j, m);
      }
  }
}

}  // namespace

dem::PairMaterials make_materials(const Scene& s, double modulus, double grain_friction) {
  dem::PairMaterials table(kMaterials);
  const double friction[kMaterials] = {
      grain_friction,       grain_friction,     s.container.friction, 0,
      s.container.friction, s.sleeper.friction, s.subgrade.friction};
  dem::PairMaterial m;
  m.modulus = modulus;
  m.tangential_ratio = s.contact.tangential_ratio;
  m.round_ratio = 2 * (1 - s.contact.poisson) / (2 - s.contact.poisson);
  m.damping = dem::damping_for_restitution(s.contact.round_law, s.contact.restitution);
  if (s.contact.round_law == "linear") m.stiffness = s.contact.stiffness;
  for (int i = 0; i < kMaterials; ++i)
    for (int j = i; j < kMaterials; ++j) {
      m.friction = i == kMirror ? 0 : friction[j];
      table.set(i, j, m);
    }
  apply_pairs(s, modulus / s.contact.modulus, table);
  return table;
}

}  // namespace trackbed::apps
