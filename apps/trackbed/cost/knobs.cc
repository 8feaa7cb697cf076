#include "apps/trackbed/cost/knobs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/effects.h"
#include "apps/trackbed/parameter_text.h"
#include "base/error.h"
#include "coupling/knobs.h"
#include "dem/grain/nearest_name.h"
#include "dem/knobs.h"
#include "fem/knobs.h"

namespace trackbed::apps {
namespace {

Knob scaled(const char* name, const char* path, const char* quantity, double factor, int cheaper,
            int finer, const char* meaning) {
  Knob knob;
  knob.name = name, knob.path = path, knob.quantity = quantity, knob.meaning = meaning;
  knob.factor = factor, knob.cheaper = cheaper, knob.finer = finer;
  return knob;
}

std::vector<Knob> scene_knobs() {
  std::vector<Knob> knobs{
      scaled("load_frequency", "Loading/Frequency", "settlement", 0.5, 2, 1,
             "a faster load takes fewer steps a cycle; grains and structures answer with inertia"),
      scaled("domain_length", "Container/Length", "settlement", 1.25, 1, 2,
             "walls across the track near the sleeper hold the ballast"),
      scaled("domain_width", "Container/Width", "settlement", 1.25, 1, 2,
             "walls or the periodic seam along the track")};
  return knobs;
}

/// Geometric mean of the numbers, or its inverse where more is finer.
double mesh_width(const Knob& knob, const std::string& text) {
  std::vector<double> values;
  parse_numbers(text, values);
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp((knob.factor < 1 ? 1 : -1) * sum / static_cast<double>(values.size()));
}

std::string digits12(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

std::string scaled_text(const Knob& knob, const std::vector<double>& own, int steps) {
  std::string text;
  for (double value : own) {
    value *= std::pow(knob.factor, steps);
    // Twelve digits: 0.1 twice halved and doubled again is 0.1.
    value = knob.whole ? std::max(1.0, std::round(value)) : std::stod(digits12(value));
    text += (text.empty() ? "" : ", ") + shortest(value);
  }
  return text;
}

}  // namespace

std::vector<Knob> all_knobs() {
  std::vector<Knob> knobs;
  for (const auto& list :
       {dem::motion_knobs(), dem::contact_knobs(), dem::grain_knobs(), dem::grading_knobs(),
        dem::packing_knobs(), fem::fem_knobs(), coupling::coupling_knobs(), scene_knobs()})
    knobs.insert(knobs.end(), list.begin(), list.end());
  return knobs;
}

std::vector<Knob> effect_knobs(const Scene& scene) {
  std::vector<Knob> knobs;
  for (const EffectKind& kind : effect_kinds()) {
    Knob knob;
    knob.name = kind.name;
    std::replace(knob.name.begin(), knob.name.end(), ' ', '_');
    knob.path = kind.path;
    knob.quantity = "settlement";
    knob.meaning = kind.adds;
    if (kind.also && !kind.is_on(scene)) knob.also = kind.also(scene);
    knob.rungs = {kind.off, kind.is_on(scene) ? scene.values.at(kind.path) : kind.on};
    knobs.push_back(knob);
  }
  return knobs;
}

std::vector<std::string> cost_quantities() {
  return {"settlement", "stiffness", "bending_moment", "pressure", "energy_drift", "porosity"};
}

std::vector<Rung> ladder(const Knob& knob, const Scene& scene) {
  const std::string& own = scene.values.at(knob.path);
  std::vector<Rung> rungs;
  if (!knob.rungs.empty()) {
    for (const auto& word : knob.rungs) rungs.push_back({word, 0, word == own});
    return rungs;
  }
  std::vector<double> numbers;
  if (!parse_numbers(own, numbers) || numbers.empty()) return rungs;
  for (int k = -knob.cheaper; k <= knob.finer; ++k) {
    Rung rung{k == 0 ? own : scaled_text(knob, numbers, k), 0, k == 0};
    rung.h = mesh_width(knob, rung.value);
    const bool known = std::any_of(rungs.begin(), rungs.end(),
                                   [&](const Rung& other) { return other.value == rung.value; });
    if (!known)
      rungs.push_back(rung);
    else if (rung.own)
      rungs.back() = rung;
  }
  return rungs;
}

bool matters_in(const Knob& knob, const Scene& scene) {
  if (knob.needs.empty()) return true;
  const bool differs = knob.needs.find("!=") != std::string::npos;
  const auto at = knob.needs.find(differs ? "!=" : "=");
  const std::string wanted = knob.needs.substr(at + (differs ? 2 : 1));
  return (scene.values.at(knob.needs.substr(0, at)) == wanted) != differs;
}

Knob knob_by_name(const std::string& name, const std::vector<Knob>& among) {
  std::vector<std::string> names;
  for (const Knob& knob : among) {
    if (knob.name == name) return knob;
    names.push_back(knob.name);
  }
  throw InputError("--knobs: unknown knob '" + name + "'; nearest: '" +
                   dem::nearest_name(name, names) + "'; known: " + join_names(names));
}

}  // namespace trackbed::apps
