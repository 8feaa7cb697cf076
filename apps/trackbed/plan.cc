#include "apps/trackbed/plan.h"

#include <algorithm>
#include <cmath>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/grain_estimate.h"
#include "apps/trackbed/layers.h"
#include "apps/trackbed/simulation/layout.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/stage.h"
#include "coupling/edit.h"
#include "dem/grain/library.h"
#include "dem/motion/time_step.h"

namespace trackbed::apps {
namespace {

// Measured on the settled default bed (tests/benchmarks), one thread.
constexpr double seconds_per_grain_step = 5e-6;
constexpr double parallel_share = 0.9;  // of the work on grains
constexpr double bytes_per_grain = 12e3;
constexpr double bytes_of_program = 150e6;

double unknowns(double nx, double ny, double nz, int order, bool periodic) {
  return 3 * (nx * order + 1) * (ny * order + (periodic ? 0 : 1)) * (nz * order + 1);
}

double sleeper_unknowns(const Scene& scene) {
  const auto& s = scene.sleeper;
  if (s.model != "elastic") return 0;
  return unknowns(s.elements[0] * (scene.container.half ? 0.5 : 1.0), s.elements[1], s.elements[2],
                  s.order, false);
}

double subgrade_unknowns(const Scene& scene) {
  const auto& s = scene.subgrade;
  if (s.model == "rigid") return 0;
  const auto& box = scene.container;
  const double length = box.length * (box.half ? 0.5 : 1.0);
  const bool given = s.elements.size() == 2;
  const double nx = given ? s.elements[0] : std::ceil(length / s.element_size - 1e-9);
  const double ny = given ? s.elements[1] : std::ceil(box.width / s.element_size - 1e-9);
  double nz = 0;
  std::string fault;
  for (const auto& layer : parse_layers(s.layers, fault))
    nz += std::ceil(layer.thickness / s.element_size - 1e-9);
  if (nz == 0) nz = std::ceil(s.depth / s.element_size - 1e-9);
  return unknowns(nx, ny, nz, s.order, box.periodic);
}

/// Forward and backward substitution with a sparse factor of about 8 n^(4/3) entries [s].
double solve_seconds(double n) { return n > 0 ? 4e-9 * 8 * std::pow(n, 4.0 / 3) : 0; }

std::string whole(double value) { return shortest(std::round(value)); }

std::vector<Effect> effects_of(const Scene& s, const Plan& plan) {
  std::vector<Effect> effects;
  auto solve = [](double n) {
    return "one solve a step, " + whole(n) + " unknowns, about " +
           shortest(std::round(1e5 * solve_seconds(n)) / 100) + " ms";
  };
  effects.push_back(
      {"elastic sleeper", plan.sleeper_unknowns > 0,
       plan.sleeper_unknowns > 0 ? solve(plan.sleeper_unknowns) : "Sleeper/Model = elastic"});
  effects.push_back({"under-sleeper pad",
                     s.sleeper.model == "elastic" && s.sleeper.pad_thickness > 0,
                     s.sleeper.model == "elastic" && s.sleeper.pad_thickness > 0
                         ? "elements of a second material"
                         : "Sleeper/Pad thickness with an elastic sleeper"});
  effects.push_back({"elastic subgrade", plan.subgrade_unknowns > 0,
                     plan.subgrade_unknowns > 0 ? solve(plan.subgrade_unknowns)
                                                : "Subgrade/Model other than rigid"});
  const bool structures = plan.sleeper_unknowns + plan.subgrade_unknowns > 0;
  effects.push_back(
      {"inertia of structures", structures && s.numerics.structure_inertia,
       structures ? "a mass matrix in the same solve" : "needs an elastic structure"});
  effects.push_back(
      {"periodic along track", s.container.periodic,
       s.container.periodic ? "images of grains at the seam" : "Container/Periodic along track"});
  effects.push_back({"half by symmetry", s.container.half,
                     s.container.half ? "saves half of the grains" : "Container/Half by symmetry"});
  effects.push_back({"shoulders", s.container.shoulder_width > 0,
                     s.container.shoulder_width > 0 ? "grains beyond the sleeper's ends"
                                                    : "Container/Shoulder width"});
  effects.push_back({"local damping while packing", s.contact.packing_damping > 0,
                     s.contact.packing_damping > 0 ? "one product per grain and step"
                                                   : "Contact/Packing damping"});
  effects.push_back({"local damping while loading", s.contact.damping > 0,
                     s.contact.damping > 0 ? "one product per grain and step; dissipates"
                                           : "Contact/Local damping"});
  effects.push_back({"tamping", s.packing.plate_cycles > 0,
                     s.packing.plate_cycles > 0
                         ? "at most " + std::to_string(s.packing.plate_cycles) + " cycles"
                         : "Packing/Plate cycles"});
  effects.push_back({"last-bit noise of the start", s.numerics.mirror_noise > 0,
                     s.numerics.mirror_noise > 0 ? "nothing" : "Numerics/Mirror noise"});
  return effects;
}

/// Some grains as small as the smallest class has them: they set the time step.
coupling::World sample_of_smallest(const Scene& scene, double size) {
  dem::LibraryParameters parameters;
  parameters.generator = scene.grains.generator;
  parameters.count = 24;
  parameters.seed = scene.grains.seed;
  std::vector<dem::GrainShape> shapes;
  for (const auto& shape : dem::make_library(parameters))
    shapes.push_back(dem::scaled(shape, size));
  coupling::World world;
  coupling::add_grains(world, shapes, std::vector<dem::Vec3>(shapes.size(), dem::Vec3::Zero()),
                       std::vector<dem::Quat>(shapes.size(), dem::Quat::Identity()),
                       scene.grains.density, kGrain);
  return world;
}

}  // namespace

Plan make_plan(const Scene& scene, int threads) {
  Plan plan{};
  double least = 1e300;
  for (const auto& k : gradation_classes(scene)) {
    plan.grains += k.grains;
    least = std::min(least, k.lower);
  }
  const Layout layout = make_layout(scene);
  plan.fill_grains = plan.grains * layout.fill_mass / layout.bed_mass;
  plan.sleeper_unknowns = sleeper_unknowns(scene);
  plan.subgrade_unknowns = subgrade_unknowns(scene);

  auto stages = packing_stages(scene);
  const auto loading = loading_stages(scene);
  stages.insert(stages.end(), loading.begin(), loading.end());
  coupling::World sample = sample_of_smallest(scene, least);
  const double given = scene.numerics.time_step;
  for (const auto& stage : stages) {
    if (stage.longest <= 0) continue;
    sample.materials = make_materials(scene, stage.modulus, stage.friction);
    const double limit = dem::expected_limit(sample.bodies, sample.shapes, sample.materials, {}).dt;
    const double dt = given > 0 ? given : stage.margin * limit;
    plan.stages.push_back({stage.name, stage.longest, dt, std::ceil(stage.longest / dt)});
  }

  const double speedup = 1 / (1 - parallel_share + parallel_share / std::max(1, threads));
  const double solve = solve_seconds(plan.sleeper_unknowns) + solve_seconds(plan.subgrade_unknowns);
  for (const auto& stage : plan.stages) {
    const bool filled = stage.name != "deposit" && stage.name != "tamping";
    const bool loads = stage.name == "seating" || stage.name == "loading";
    const double count = plan.grains + (filled ? plan.fill_grains : 0);
    plan.seconds += stage.steps * (seconds_per_grain_step * count / speedup + (loads ? solve : 0));
  }
  const double n_fe = plan.sleeper_unknowns + plan.subgrade_unknowns;
  plan.memory = bytes_of_program + bytes_per_grain * (plan.grains + plan.fill_grains) +
                12 * 8 * std::pow(n_fe, 4.0 / 3) + 12 * 81 * n_fe;
  plan.effects = effects_of(scene, plan);
  return plan;
}

}  // namespace trackbed::apps
