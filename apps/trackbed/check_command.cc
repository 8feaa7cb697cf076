// `trackbed check`: the plan of a scene on one page.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/grain_estimate.h"
#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/plan.h"
#include "apps/trackbed/progress.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/layout.h"
#include "apps/trackbed/simulation/replay.h"
#include "apps/trackbed/simulation/seam.h"
#include "apps/trackbed/simulation/zones.h"
#include "dem/grain/library_report.h"

namespace trackbed::apps {
namespace {

void print_grains(const Scene& scene, const Plan& plan) {
  std::printf("Grains      about %.0f in the bed (%.1f kg)", plan.grains,
              make_layout(scene).bed_mass);
  if (plan.fill_grains >= 1) std::printf(", %.0f beside the sleeper", plan.fill_grains);
  std::printf("\n");
  for (const auto& k : gradation_classes(scene))
    std::printf("            %5.1f to %5.1f mm  %5.1f %%  %7.2f kg  %6.0f grains\n", 1e3 * k.lower,
                1e3 * k.upper, 100 * k.share, k.mass, k.grains);
  if (!scene.zones.use) return;
  std::printf("Zones       grains, mass; grains if all were fine\n");
  for (const auto& z : estimate_zones(scene))
    std::printf("            %-12s %6.0f %9.2f kg %6.0f\n", z.name.c_str(), z.grains, z.mass,
                z.all_fine);
  std::printf("            computing %s; %s if all were fine, %.2f times as long\n",
              duration_text(plan.seconds).c_str(), duration_text(plan.seconds_all_fine).c_str(),
              plan.seconds_all_fine / plan.seconds);
}

/// Form of the library by some of its shapes: making and sizing all of a large one takes minutes.
void print_library(const Scene& scene) {
  constexpr int most = 200;
  dem::LibraryParameters p = library_parameters(scene);
  const int all = p.count;
  const double share = p.files.empty() ? std::min(1.0, double(most) / all) : 1;
  p.count = static_cast<int>(std::ceil(share * all));
  p.needles = static_cast<int>(std::floor(share * p.needles));
  p.flakes = static_cast<int>(std::floor(share * p.flakes));
  const dem::LibraryReport r = dem::library_report(dem::make_library(p));
  std::printf("Shapes      %s", scene.grains.generator.c_str());
  if (p.files.empty() && p.count < all) std::printf(", a sample of its %d", all);
  std::printf(
      ": %d, sphericity %.3f, angularity %.3f, elongation %.3f, flatness %.3f, %.0f faces\n",
      r.shapes, r.sphericity.mean, r.angularity.mean, r.elongation.mean, r.flatness.mean,
      r.faces.mean);
  std::printf("            flakiness index %.1f %%, elongation index %.1f %% of the volume",
              r.indices.flaky, r.indices.elongated);
  const GradationScene& g = scene.gradation;
  if (g.needle_share > 0 || g.flaky_share > 0)
    std::printf("; drawn %g %% flaky, %g %% needles", g.flaky_share, g.needle_share);
  std::printf("\n");
}

void print_sleeper_and_load(const Scene& scene) {
  std::printf("Sleeper     %s, %g x %g x %g m\n", scene.sleeper.model.c_str(), scene.sleeper.length,
              scene.sleeper.width, scene.sleeper.height);
  std::printf("Subgrade    %s\n", scene.subgrade.model.c_str());
  std::printf("Load        %g to %g kN at %g Hz, %d cycles\n", 1e-3 * scene.loading.least,
              1e-3 * scene.loading.largest, scene.loading.frequency, scene.loading.cycles);
}

/// The mean grain size by mass is that of the classes' middles.
void print_test(const Scene& scene) {
  const GrainTestScene& t = scene.test;
  std::printf("Test        %s", t.type.c_str());
  if (t.type != "angle_of_repose") {
    std::printf(", %s stress", t.type == "triaxial" ? "confining" : "normal");
    for (const double p : t.stresses) std::printf(" %g", 1e-3 * p);
    std::printf(" kPa");
  }
  if (t.type == "triaxial")
    std::printf(", to %g %% at %g /s", 100 * t.largest_strain, t.strain_rate);
  if (t.type == "direct_shear") std::printf(", %g mm at %g m/s", 1e3 * t.travel, t.speed);
  if (t.type == "angle_of_repose")
    std::printf(", wall lifted at %g m/s, %g m of floor", t.speed, t.floor_length);
  std::printf("\n");
  double size = 0, share = 0;
  for (const auto& k : gradation_classes(scene))
    size += k.share * (k.lower + k.upper) / 2, share += k.share;
  const double inertial = inertial_number(scene, size / share);
  if (inertial > 0)
    std::printf("            inertial number %.2g%s\n", inertial,
                inertial > kQuasiStatic ? ", over 1e-3: not quasi-static, too fast" : "");
}

void print_effects(const Plan& plan) {
  std::printf("\nOn\n");
  for (const auto& e : plan.effects)
    if (e.on) std::printf("  %-28s %s\n", e.name.c_str(), e.cost.c_str());
  std::printf("Off (computed nowhere)         would be switched on by\n");
  for (const auto& e : plan.effects)
    if (!e.on) std::printf("  %-28s %s\n", e.name.c_str(), e.cost.c_str());
}

void print_stages(const Plan& plan) {
  std::printf("\nStage               usually [s]  at most [s]  time step [s]       steps\n");
  for (const auto& s : plan.stages)
    std::printf("%-18s %12.4g %12.4g %14.2e %11.0f\n", s.name.c_str(), s.duration, s.longest,
                s.time_step, s.steps);
}

}  // namespace

int check_command(const CheckOptions& options) {
  const Scene scene = read_scene(options.scene, options.set);
  if (is_replay(scene)) {
    std::printf("%s: the bodies of %s alone, %d steps of %g s; no walls, sleeper or load.\n",
                scene.file.c_str(), scene.replay.bodies.c_str(), scene.replay.steps,
                scene.numerics.time_step);
    std::printf("The scene is valid; nothing was run.\n");
    return 0;
  }
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int threads = options.threads > 0 ? options.threads : cores > 0 ? cores : 1;
  const Plan plan = make_plan(scene, threads);
  check_seam_of_drawn(scene);

  std::printf("%s: %s\n\n", scene.file.c_str(), scene.title.c_str());
  std::printf("Container   %g x %g m, %g m deep%s%s\n", scene.container.length,
              scene.container.width, scene.container.depth,
              scene.container.periodic ? ", periodic along the track" : "",
              scene.container.half ? ", half by symmetry" : "");
  if (scene.test.on())
    print_test(scene);
  else
    print_sleeper_and_load(scene);
  print_grains(scene, plan);
  print_library(scene);
  print_effects(plan);
  for (const auto& why : scene.decisions) std::printf("Decided     %s\n", why.c_str());
  print_stages(plan);
  std::printf("\nEstimates: memory %.0f MB, computing %s with %d thread%s.\n", 1e-6 * plan.memory,
              duration_text(plan.seconds).c_str(), threads, threads == 1 ? "" : "s");
  std::printf("The scene is valid; nothing was run.\n");
  return 0;
}

}  // namespace trackbed::apps
