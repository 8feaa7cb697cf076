// The same bits: a run that goes on from a checkpoint's file and the one that never stopped, any
// number of threads, run and run again.
#include "coupling_scene.h"
#include "grain_scene.h"
#include "tests/scratch_folder.h"
#include "world_state.h"

namespace trackbed::hard {
namespace {

using namespace coupling;

const Vec3 kNoGravity = Vec3::Zero();

// Eight grains that fly at each other.
World cloud(const Setting& set, dem::StepContext& c) {
  const double size = .05;
  dem::Scene s = scene_of(set, 1e8, .5, size);
  const dem::GrainShape g = grain(set.shape, size);
  dem::Random random(3);
  for (int k = 0; k < 8; ++k) {
    const Vec3 at(k % 2 - .5, k / 2 % 2 - .5, k / 4 - .5);
    // Needles miss each other unless they are near.
    const int i = s.add(g, 2600, (set.shape == "needle" ? .4 : 2.1) * g.radius * at,
                        dem::turn_about(random.direction(), random.uniform(0, 6)));
    s.bodies.v[i] = -20 * s.bodies.x[i] + .3 * random.direction();
  }
  s.prepare();
  World w;
  w.shapes = s.shapes, w.bodies = s.bodies, w.materials = s.materials;
  w.pair_forces = s.forces, w.round_forces = s.round;
  c = context(.2 * dem::expected_limit(s.bodies, s.shapes, s.materials, {.3, 6}).dt, kNoGravity);
  start(w, c);
  return w;
}

// Four grains thrown on an elastic block.
World thrown(const Setting& set, dem::StepContext& c) {
  World w = bed(2, 1);
  w.exchange.schedule = schedule_named(set.schedule);
  w.exchange.grain_steps = set.grain_steps;
  for (int i = 0; i < w.bodies.grains; ++i) w.bodies.v[i] = {.3, 0, -3};
  c = context(4e-5 / std::max(1, set.grain_steps), kNoGravity);
  start(w, c);
  return w;
}

using Make = World (*)(const Setting&, dem::StepContext&);

// Runs until something touches, saves, goes on; the other goes on from the file. 1: bits differ.
template <Make make>
Measured restart(const Setting& set) {
  const ScratchFolder folder;
  const std::string path = folder.file("checkpoint.h5");
  dem::StepContext c;
  World w = make(set, c);
  for (int k = 0; k < 20000 && count_contacts(w) == 0; ++k) run(w, c, 1);
  run(w, c, 20);
  if (count_contacts(w) == 0 && set.grain_steps < 30) return {HUGE_VAL, 0};
  save(w, path);
  run(w, c, 60);
  World again = make(set, c);
  load(again, path);
  run(again, c, 60);
  const std::string names = differing(w, again, kNoGravity);
  if (!names.empty()) std::fprintf(stderr, "restart: %s\n", names.c_str());
  return {names.empty() ? 0. : 1., 0};
}

template <Make make>
Measured threads(const Setting& set) {
  dem::StepContext c;
  World first = make(set, c);
  run(first, c, 300);
  for (const int n : {2, 8, 1}) {
    World w = make(set, c);
    c.threads = n;
    run(w, c, 300);
    if (!differing(first, w, kNoGravity).empty()) return {1, 0};
  }
  return {0, 0};
}

}  // namespace

const std::vector<Case>& saved_cases() {
  static const std::vector<Case> cases{
      {"restart from a checkpoint's file, grains", "bitwise the uninterrupted run",
       "1 = bits differ", "none", Over::all_shapes, false, false, restart<cloud>},
      {"restart from a checkpoint's file, grains on elements", "bitwise the uninterrupted run",
       "1 = bits differ", "none", Over::schedules, false, false, restart<thrown>},
      {"threads 1, 2, 8 and again 1, grains", "bitwise the same", "1 = bits differ", "none",
       Over::all_shapes, false, false, threads<cloud>},
      {"threads 1, 2, 8 and again 1, grains on elements", "bitwise the same", "1 = bits differ",
       "none", Over::schedules, false, false, threads<thrown>}};
  return cases;
}

}  // namespace trackbed::hard
