#include "apps/trackbed/plan.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/effects.h"
#include "apps/trackbed/grain_estimate.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/layout.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/replay.h"
#include "apps/trackbed/simulation/seam.h"
#include "apps/trackbed/simulation/stage.h"
#include "apps/trackbed/simulation/structures.h"
#include "apps/trackbed/simulation/zones.h"
#include "base/error.h"
#include "coupling/edit.h"
#include "dem/grain/library.h"
#include "dem/motion/time_step.h"
#include "fem/modal_structure.h"

namespace trackbed::apps {
namespace {

// Measured on settled beds with one thread (tests/benchmarks).
constexpr double seconds_per_grain_step = 1.5e-6;
constexpr double seconds_per_surface_contact = 1.5e-6;  // grain on a deforming surface
constexpr double static_rounds = 15;                    // a step, of an exchange without inertia
constexpr double iterated_rounds = 3;
constexpr double parallel_share = 0.9;  // of the work on grains
constexpr double bytes_per_grain = 12e3;
constexpr double bytes_of_program = 150e6;
// Stages end when the bed is at rest, mostly long before their limit [s].
constexpr double usual_deposit = 0.5, usual_settling = 0.2, usual_hardening = 0.1,
                 usual_consolidation = 0.1;

/// A structure is built and takes some steps: no estimate knows a model of the user's own.
StructureCost measure(fem::Structure& structure, double dt) {
  using Clock = std::chrono::steady_clock;
  StructureCost cost;
  cost.unknowns = structure.unknowns();
  structure.set_step(std::min(dt, structure.largest_step()));
  const auto* body = dynamic_cast<const fem::ElasticBody*>(&structure);
  cost.solves = body && !body->is_explicit();
  if (const auto* modal = dynamic_cast<const fem::ModalStructure*>(&structure))
    if (const auto report = modal->model().report) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "; of %d: frequencies to %.1g %%, even pressure to %.1g %%, one node's dent to "
                    "%.2g %%",
                    report->unknowns, 100 * report->largest_frequency_error,
                    100 * std::abs(report->pressure_error), 100 * report->node_error);
      cost.reduction = text;
    }
  const std::vector<fem::Vec> no_forces(structure.surface().nodes.size(), fem::Vec{0, 0, 0});
  std::vector<fem::Vec> u, v;
  structure.advance(no_forces);  // the first one warms up
  cost.seconds = 1e300;          // the fastest of some: what is left when nothing else runs
  for (int steps = 0; steps < 10; ++steps) {
    const auto start = Clock::now();
    structure.predict(u, v);
    structure.advance(no_forces);
    const std::chrono::duration<double> taken = Clock::now() - start;
    cost.seconds = std::min(cost.seconds, taken.count());
  }
  if (body && body->solver_iterations() > 0)
    cost.reduction += "; " + std::to_string(body->solver_iterations()) + " iterations a solve";
  return cost;
}

/// Some shapes as small as the smallest class has them.
std::vector<dem::GrainShape> sample_of_smallest(const Scene& scene, double size) {
  dem::LibraryParameters parameters = library_parameters(scene);
  parameters.count = std::max(24, parameters.needles + parameters.flakes);
  std::vector<dem::GrainShape> shapes;
  for (const auto& shape : make_grain_library(scene, parameters, {}))
    shapes.push_back(dem::scaled(shape, size));
  return shapes;
}

/// They set the time step.
coupling::World world_of(const Scene& scene, const std::vector<dem::GrainShape>& shapes) {
  coupling::World world;
  coupling::add_grains(world, shapes, std::vector<dem::Vec3>(shapes.size(), dem::Vec3::Zero()),
                       std::vector<dem::Quat>(shapes.size(), dem::Quat::Identity()),
                       scene.grains.density, kGrain);
  return world;
}

/// What half of the sample's shapes are too long for is refused without drawing grains; the rest
/// by check_seam_of_drawn() and by a run before it packs.
void check_period(const Scene& scene, const std::vector<dem::GrainShape>& sample, double enlarged) {
  std::vector<double> radius;
  for (const dem::GrainShape& g : sample) radius.push_back(g.radius);
  const auto middle = radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2);
  std::nth_element(radius.begin(), middle, radius.end());
  dem::GrainShape typical;
  typical.radius = enlarged * *middle;
  check_seam(sample_layout(scene).period.y(), {typical});
}

/// A run measures the limit of its own grains; what is far over the sample's is refused there.
void check_time_step(const Scene& scene, const Stage& stage, double limit) {
  const double given = scene.numerics.time_step;
  if (given <= 1.5 * limit || is_replay(scene)) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "Numerics/Time step: %.3g s is over the stability limit of stage '%s' "
                "(about %.3g s); %.3g s would do",
                given, stage.name.c_str(), limit, stage.margin * limit);
  throw InputError(text);
}

}  // namespace

Plan make_plan(const Scene& scene, int threads) {
  Plan plan{};
  double least = 1e300, largest = 0;
  for (const auto& k : gradation_classes(scene)) {
    plan.grains += k.grains;
    least = std::min(least, k.lower);
    largest = std::max(largest, 0.5 * (k.lower + k.upper));
  }
  const Layout layout = make_layout(scene);
  plan.fill_grains = plan.grains * layout.fill_mass / layout.bed_mass;
  if (scene.zones.use) {
    double zoned = 0;
    for (const ZoneEstimate& z : estimate_zones(scene))
      zoned += z.grains, plan.all_fine += z.all_fine;
    plan.grains *= zoned / plan.all_fine, plan.fill_grains *= zoned / plan.all_fine;
  }

  auto stages = packing_stages(scene);
  const auto loading = loading_stages(scene);
  stages.insert(stages.end(), loading.begin(), loading.end());
  const auto smallest = sample_of_smallest(scene, least);
  check_period(scene, smallest, largest / least);
  coupling::World sample = world_of(scene, smallest);
  const double given = scene.numerics.time_step;
  dem::ContactExpectation expect;
  expect.flat_faces = dem::make_round_forces(scene.contact.round_law, true).flat_faces;
  for (const auto& stage : stages) {
    if (stage.longest <= 0) continue;
    sample.materials = make_materials(scene, stage.modulus, stage.friction);
    const double limit =
        dem::expected_limit(sample.bodies, sample.shapes, sample.materials, expect).dt;
    check_time_step(scene, stage, limit);
    const double dt = given > 0 ? given : stage.margin * limit;
    const double rungs = stage.again ? static_cast<double>(scene.packing.friction_path.size()) : 1;
    const double usual = stage.name == "deposit"                     ? usual_deposit
                         : stage.name == "hardening"                 ? usual_hardening
                         : stage.until_quiet                         ? usual_settling * rungs
                         : stage.name.rfind("consolidation", 0) == 0 ? usual_consolidation
                                                                     : stage.longest;
    const double longest = rungs * stage.longest;
    const double duration = std::min(usual, longest);
    plan.stages.push_back(
        {stage.name, duration, longest, dt, std::ceil(duration / dt), stage.ledger, 0});
  }

  const double dt = plan.stages.empty() ? 1e-5 : plan.stages.back().time_step;
  double area = 0;  // of deforming surfaces
  if (scene.sleeper.model != "rigid") {
    plan.sleeper = measure(*make_elastic_sleeper(scene, layout, 0), dt);
    area += (layout.sleeper_high_x - layout.sleeper_low_x) * scene.sleeper.width;
  }
  if (scene.subgrade.model != "rigid") {
    plan.subgrade = measure(*make_subgrade_structure(scene, layout), dt);
    area += (layout.high - layout.low).head<2>().prod();
  }
  // Evaluations of surfaces and structures a step: an exchange that is iterated.
  const bool held = scene.subgrade.model != "rigid" && scene.subgrade.inertia == "off";
  const double rounds = held                                    ? static_rounds
                        : scene.numerics.exchange == "iterated" ? iterated_rounds
                                                                : 1;
  // Of a stage in a bed of `finer` times as many grains.
  const auto seconds = [&](const PlanStage& stage, double finer) {
    const double bed = finer * plan.grains;
    const double d = std::cbrt(layout.bed_mass / (scene.grains.density * 0.6 * bed));
    const bool filled = stage.name != "deposit" && stage.name != "tamping";
    const double count = bed + (filled ? finer * plan.fill_grains : 0);
    // As many threads as a step uses (stages.cc).
    const double workers = std::min<double>(threads, 1 + std::floor(count / 100));
    double step = seconds_per_grain_step * count;
    if (stage.loads) step += rounds * seconds_per_surface_contact * area / (d * d);
    step *= 1 - parallel_share + parallel_share / std::max(1.0, workers);
    if (stage.loads) step += rounds * (plan.sleeper.seconds + plan.subgrade.seconds);
    return stage.steps * step;
  };
  for (auto& stage : plan.stages) {
    stage.seconds = seconds(stage, 1);
    plan.seconds += stage.seconds;
    if (plan.all_fine > 0)
      plan.seconds_all_fine += seconds(stage, plan.all_fine / (plan.grains + plan.fill_grains));
  }
  const auto factor = [](const StructureCost& c) {
    return 12 * 81 * c.unknowns + (c.solves ? 12 * 8 * std::pow(c.unknowns, 4.0 / 3) : 0);
  };
  plan.memory = bytes_of_program + bytes_per_grain * (plan.grains + plan.fill_grains) +
                factor(plan.sleeper) + factor(plan.subgrade);
  plan.effects = effects_of(scene, plan);
  return plan;
}

}  // namespace trackbed::apps
