#include "apps/trackbed/inertia.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/trackbed/simulation/structures.h"

namespace trackbed::apps {
namespace {

constexpr double kPower = 0.99;

// Share of each harmonic by sums over the table's cycle, sampled finer than its rows.
int highest_of_table(const LoadTable& table) {
  const int samples = std::max(1024, 8 * static_cast<int>(table.time.size()));
  std::vector<double> load(samples);
  double mean = 0, power = 0;
  for (int k = 0; k < samples; ++k) {
    load[k] = table.at(table.period() * k / samples);
    mean += load[k] / samples;
  }
  for (const double f : load) power += (f - mean) * (f - mean) / samples;
  double carried = 0;
  for (int n = 1; n < samples / 2; ++n) {
    double a = 0, b = 0;
    for (int k = 0; k < samples; ++k) {
      const double phase = 2 * M_PI * n * k / samples;
      a += 2 * load[k] * std::cos(phase) / samples, b += 2 * load[k] * std::sin(phase) / samples;
    }
    carried += 0.5 * (a * a + b * b);
    if (carried >= kPower * power) return n;
  }
  return samples / 2;
}

const fem::ElasticBody* as_body(const fem::Structure* s) {
  return dynamic_cast<const fem::ElasticBody*>(s);
}

std::unique_ptr<fem::Structure> coarse_subgrade(Scene scene) {
  if (scene.subgrade.model == "rigid") return nullptr;
  const Layout l = make_layout(scene);
  scene.subgrade.element_size = std::max(
      scene.subgrade.element_size, 0.25 * std::min(l.high.x() - l.low.x(), l.high.y() - l.low.y()));
  scene.subgrade.reduction = "none";
  scene.subgrade.inertia = "on";
  return make_subgrade_structure(scene, l);
}

// Why the subgrade cannot be static; empty: it can.
std::string no_static_form(const Scene& s) {
  if (!as_body(coarse_subgrade(s).get()))
    return "Subgrade/Model = " + s.subgrade.model + " is no elastic body";
  if (s.subgrade.reduction != "none")
    return "Subgrade/Reduction = " + s.subgrade.reduction + " gives modes, which have inertia";
  if (s.subgrade.absorbing != "none")
    return "Subgrade/Absorbing = " + s.subgrade.absorbing + " lets waves out, which need inertia";
  if (s.subgrade.damping_ratio > 0)
    return "Subgrade/Damping ratio = " + s.values.at("Subgrade/Damping ratio") +
           " damps motion, which a static answer has none of";
  return "";
}

}  // namespace

double highest_harmonic(const LoadingScene& l) {
  if (l.waveform == "table") return highest_of_table(l.history) * l.frequency;
  return (l.waveform == "triangle" ? 3 : 1) * l.frequency;
}

double first_mode_of_subgrade(const Scene& scene) {
  const auto structure = coarse_subgrade(scene);
  const auto* body = as_body(structure.get());
  return body ? body->frequencies(1)[0] : 0;
}

void decide_inertia(Scene& scene, const ParameterValues& values) {
  SubgradeScene& s = scene.subgrade;
  if (s.model == "rigid") {
    s.inertia = "off";
    return;
  }
  const bool by_scheme = scene.numerics.scheme == "static";
  if (s.inertia == "on" && !by_scheme) return;
  const std::string not_static = no_static_form(scene);
  if (s.inertia == "auto" && !by_scheme) {
    char why[200];
    if (!not_static.empty()) {
      s.inertia = "on";
      std::snprintf(why, sizeof why, "on, %s", not_static.c_str());
    } else {
      const double load = highest_harmonic(scene.loading), mode = first_mode_of_subgrade(scene);
      const bool slow = load < kSlowLoad * mode;
      s.inertia = slow ? "off" : "on";
      std::snprintf(why, sizeof why,
                    "%s, the load's harmonics reach %.3g Hz (99 %% of its power), the first mode "
                    "is at %.3g Hz; below a quarter of it inertia adds less than 6.7 %%",
                    s.inertia.c_str(), load, mode);
    }
    scene.values["Subgrade/Inertia"] = s.inertia;
    scene.decisions.push_back("Subgrade/Inertia = auto: " + std::string(why));
    if (s.inertia == "on") return;
  }
  s.inertia = "off";
  const std::string path = by_scheme ? "Numerics/Structure scheme" : "Subgrade/Inertia";
  if (!not_static.empty()) values.refuse(path, "not possible, " + not_static);
  std::string& exchange = scene.numerics.exchange;
  if (exchange == "predicted") {
    exchange = "iterated";
    scene.values["Numerics/Exchange"] = exchange;
    scene.decisions.push_back(
        "Numerics/Exchange = predicted: iterated, a surface without inertia obeys forces at once "
        "and a predicted one grows where contacts are stiffer than a third of it; some 15 rounds a "
        "step: where inertia needs no solve, off takes longer than on");
  } else if (exchange != "iterated") {
    values.refuse(path,
                  "a subgrade without inertia needs Numerics/Exchange = iterated, not " + exchange);
  }
}

}  // namespace trackbed::apps
