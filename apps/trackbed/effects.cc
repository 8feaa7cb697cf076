#include "apps/trackbed/effects.h"

#include <cmath>
#include <cstdio>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/actors.h"

namespace trackbed::apps {
namespace {

std::string rounded(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", x);
  return text;
}

std::string text_of(const StructureCost& c) {
  if (c.unknowns == 0) return "one solve or product a step";  // not measured
  return shortest(std::round(c.unknowns)) + " unknowns, each step " +
         (c.solves ? "one solve, " : "no solve, ") + shortest(std::ceil(1e5 * c.seconds) / 100) +
         " ms" + c.reduction;
}

std::string tamping_cost(const Scene& s, const Plan&) {
  return "at most " + std::to_string(s.packing.plate_cycles) + " cycles";
}

std::string path_cost(const Scene& s, const Plan&) {
  return std::to_string(s.packing.friction_path.size()) +
         " frictions, then a search between two of them";
}

/// Beds at rest within Packing/Unbalanced force take longer than a bed that is only tamped.
std::vector<std::string> path_time(const Scene& s) {
  constexpr double enough = 3;  // [s]
  if (s.packing.settle_time >= enough) return {};
  return {"Packing/Settle time=" + shortest(enough)};
}

std::string copies_cost(const Scene& s, const Plan&) {
  return std::to_string(s.packing.layers * s.packing.bays) +
         " copies of a sample, whose seams settle; packs only that many times fewer grains";
}

std::string zones_cost(const Scene&, const Plan& plan) {
  if (plan.all_fine == 0) return "fewer grains outside";  // not estimated
  const double share = 1 - (plan.grains + plan.fill_grains) / plan.all_fine;
  return shortest(std::round(100 * share)) + " % fewer grains than the " +
         shortest(std::round(plan.all_fine)) + " of a bed that is fine everywhere";
}

std::string push_cost(const Scene& s, const Plan& plan) {
  std::string text = "a stage of its own after the load cycles";
  const SleeperScene& l = s.sleeper;
  const double mass = l.density * l.length * l.width * l.height;
  for (const PlanStage& stage : plan.stages)
    if (stage.name == "push" &&
        push_stiffness(s.loading, mass, stage.time_step) < s.loading.push_stiffness)
      text += "; Push stiffness lowered to about " +
              rounded(push_stiffness(s.loading, mass, stage.time_step)) +
              " N/m, which a sleeper of " + rounded(mass) + " kg bears at such steps";
  return text;
}

std::string exchange_cost(const Scene& s, const Plan&) {
  const NumericsScene& n = s.numerics;
  if (n.exchange == "several_steps")
    return "structures step once in " + std::to_string(n.grain_steps) + " grain steps";
  if (n.exchange == "iterated")
    return "two or three structure steps and surface evaluations a step";
  return n.exchange;
}

}  // namespace

const std::vector<EffectKind>& effect_kinds() {
  static const std::vector<EffectKind> kinds{
      {"elastic sleeper", "Sleeper/Model", "rigid", "elastic",
       "a finite element step, contacts with its deforming surface",
       [](const Scene& s) { return s.sleeper.model != "rigid"; },
       [](const Scene&, const Plan& p) { return text_of(p.sleeper); }},
      {"under-sleeper pad", "Sleeper/Pad thickness", "0", "0.01", "elements of a second material",
       [](const Scene& s) { return s.sleeper.model != "rigid" && s.sleeper.pad_thickness > 0; },
       nullptr},
      {"rail pads", "Sleeper/Pad stiffness", "0", "1e8",
       "a spring and dashpot at each seat, solved by one formula a step",
       [](const Scene& s) { return s.sleeper.rail_pad.stiffness > 0; }, nullptr},
      {"elastic subgrade", "Subgrade/Model", "rigid", "layered_elastic",
       "a finite element step, contacts with its deforming surface",
       [](const Scene& s) { return s.subgrade.model != "rigid"; },
       [](const Scene&, const Plan& p) { return text_of(p.subgrade); }},
      {"inertia of the subgrade", "Subgrade/Inertia", "off", "on",
       "waves and their energy; off: some 15 rounds a step of its contacts and a static solve, "
       "which "
       "takes longer where inertia needs no solve",
       [](const Scene& s) { return s.subgrade.model != "rigid" && s.subgrade.inertia != "off"; },
       nullptr},
      {"modes of the sleeper", "Sleeper/Reduction", "none", "condensed",
       "a basis at the start; then products of its size instead of solves",
       [](const Scene& s) { return s.sleeper.model == "elastic" && s.sleeper.reduction != "none"; },
       nullptr},
      {"modes of the subgrade", "Subgrade/Reduction", "none", "condensed",
       "a basis at the start; then products of its size instead of solves",
       [](const Scene& s) { return s.subgrade.model != "rigid" && s.subgrade.reduction != "none"; },
       nullptr},
      {"absorbing boundaries", "Subgrade/Absorbing", "none", "all",
       "dashpots on the subgrade's boundaries: always a solve",
       [](const Scene& s) { return s.subgrade.model != "rigid" && s.subgrade.absorbing != "none"; },
       nullptr},
      {"damping of the subgrade", "Subgrade/Damping ratio", "0", "0.03",
       "a matrix of its own: always a solve; dissipates",
       [](const Scene& s) { return s.subgrade.model != "rigid" && s.subgrade.damping_ratio > 0; },
       nullptr},
      {"push of the sleeper", "Loading/Push", "none", "longitudinal",
       "a stage of its own after the load cycles",
       [](const Scene& s) { return s.loading.push != "none"; }, push_cost},
      {"periodic along track", "Container/Periodic along track", "false", "true",
       "images of grains at the seam", [](const Scene& s) { return s.container.periodic; },
       nullptr},
      {"half by symmetry", "Container/Half by symmetry", "false", "true",
       "saves half of the grains", [](const Scene& s) { return s.container.half; }, nullptr},
      {"shoulders", "Container/Shoulder width", "0", "0.3", "grains beyond the sleeper's ends",
       [](const Scene& s) { return s.container.shoulder_width > 0; }, nullptr},
      {"local damping while packing", "Contact/Packing damping", "0", "0.4",
       "one product per grain and step",
       [](const Scene& s) {
         return s.contact.damping_kind == "local" && s.contact.packing_damping > 0;
       },
       nullptr},
      {"local damping while loading", "Contact/Local damping", "0", "0.1",
       "one product per grain and step; dissipates",
       [](const Scene& s) { return s.contact.damping_kind == "local" && s.contact.damping > 0; },
       nullptr},
      {"adaptive damping", "Contact/Damping", "none", "adaptive",
       "two sums of the kinetic energy a step; dissipates",
       [](const Scene& s) { return s.contact.damping_kind == "adaptive"; }, nullptr},
      {"round grains", "Grains/Shape", "polyhedron", "dilated",
       "Hertz contacts of spheres, clumps or dilated cores instead of overlap volumes",
       [](const Scene& s) {
         return s.grains.shape != "polyhedron" ||
                (s.grains.other_share > 0 && s.grains.other_shape != "polyhedron");
       },
       nullptr},
      {"torsional friction", "Contact/Torsional friction", "0", "1",
       "a pass over touching pairs, 48 bytes a pair",
       [](const Scene& s) { return s.contact.torsion > 0; }, nullptr},
      {"rolling resistance", "Contact/Rolling resistance", "0", "0.1",
       "a pass over touching pairs, 48 bytes a pair",
       [](const Scene& s) { return s.contact.rolling > 0; }, nullptr},
      {"tamping", "Packing/Plate cycles", "0", "8", "cycles of a plate on the bed",
       [](const Scene& s) { return s.packing.method == "tamping" && s.packing.plate_cycles > 0; },
       tamping_cost},
      {"quasi-vibration", "Packing/Method", "tamping", "quasi_vibration",
       "beds at rest for friction after friction",
       [](const Scene& s) { return s.packing.method == "quasi_vibration"; }, path_cost, path_time},
      {"layers of one sample", "Packing/Layers", "1", "2", "seams that settle; less to pack",
       [](const Scene& s) { return s.packing.layers * s.packing.bays > 1; }, copies_cost},
      {"zones", "Zones/Use", "false", "true", "fewer and simpler grains outside",
       [](const Scene& s) { return s.zones.use; }, zones_cost},
      {"exchange other than predicted", "Numerics/Exchange", "predicted", "iterated",
       "more surface evaluations a step, or fewer steps of the structures",
       [](const Scene& s) { return s.numerics.exchange != "predicted"; }, exchange_cost},
      {"last-bit noise of the start", "Numerics/Mirror noise", "0", "1e-15", "nothing",
       [](const Scene& s) { return s.numerics.mirror_noise > 0; }, nullptr}};
  return kinds;
}

std::vector<Effect> effects_of(const Scene& scene, const Plan& plan) {
  std::vector<Effect> effects;
  for (const EffectKind& kind : effect_kinds()) {
    const bool on = kind.is_on(scene);
    effects.push_back({kind.name, on,
                       !on         ? kind.path + " = " + kind.on
                       : kind.cost ? kind.cost(scene, plan)
                                   : kind.adds});
  }
  return effects;
}

void write_effects(const Scene& scene, const std::string& file) {
  CsvWriter csv(file, {"effect", "on", "cost_or_switch"});
  for (const Effect& e : effects_of(scene, {})) csv.row({e.name, e.on, e.cost});
  for (const std::string& why : scene.decisions) csv.row({"decided", true, why});
  csv.flush();
}

std::string effects_markdown() {
  std::string text =
      "\n## Effects\n\nWhat a scene may leave out; what is off is computed nowhere.\n\n"
      "| Effect | Key | Off | On, such as | Adds |\n|---|---|---|---|---|\n";
  for (const EffectKind& k : effect_kinds())
    text +=
        "| " + k.name + " | " + k.path + " | `" + k.off + "` | `" + k.on + "` | " + k.adds + " |\n";
  return text;
}

}  // namespace trackbed::apps
