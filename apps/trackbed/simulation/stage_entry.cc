#include "apps/trackbed/simulation/stage_entry.h"

#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/stage_step.h"

namespace trackbed::apps {
namespace {

// By the scene, or in a packing that was taken from files.
bool has_round_grains(const Run& run) {
  const Scene& s = run.scene;
  if (has_shape(s, "sphere") || has_shape(s, "clump") || has_shape(s, "dilated")) return true;
  const dem::ShapeTable& shapes = run.world.shapes;
  for (int k = 0; k < shapes.size(); ++k)
    for (const dem::ConvexPart& part : shapes.shape(k).parts)
      if (part.radius > 0) return true;
  return false;
}

}  // namespace

void choose_laws(Run& run, const Stage& stage) {
  coupling::World& w = run.world;
  const ContactScene& c = run.scene.contact;
  w.materials = make_materials(run.scene, stage.modulus, run.stage.friction);
  w.pair_forces = dem::make_pair_forces(c.law, true);
  w.patch_forces = dem::make_patch_forces(c.law, true);
  if (has_round_grains(run)) {
    w.round_forces = dem::make_round_forces(c.round_law, true);
    w.round_patch_forces = dem::make_round_patch_forces(c.round_law, true);
  }
  w.resistance = {c.torsion, c.rolling};
  w.adaptive = c.damping_kind == "adaptive";
}

void enter_stage(Run& run, const Stage& stage) {
  run.stage.friction = stage.friction;
  run.stage.stop_at = 0;
  stage.enter(run);
  choose_laws(run, stage);
  run.world.adaptive_damping = {};
  StageState& s = run.stage;
  s.steps = s.cycles = s.halvings = 0;
  s.start = run.world.time;
  if (!stage.goes_on) {  // others may have come or gone since
    s.grain_force.assign(run.world.bodies.grains, 0.0);
    s.largest_overlap = s.largest_step_share = 0;
  }
  apply_load(run, stage.load(run, 0));
  // Positions, not motion: forces where everything stands.
  s.dt = 0;
  coupling::prepare(run.world, step_context(run, stage));
  choose_step(run, stage);
  if (stage.ledger) {
    if (run.scene.numerics.mirror_noise > 0)
      run.world.bodies.x[0] *= 1 + run.scene.numerics.mirror_noise;
    coupling::open_ledger(run.world, step_context(run, stage).gravity);
    s.work_in = s.last_work = s.worst_closure = s.pad_work = s.pad_loss = 0;
    s.exchange_gain = s.structure_gain = 0;
  }
}

}  // namespace trackbed::apps
