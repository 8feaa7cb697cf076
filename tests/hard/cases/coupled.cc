// Grains on finite elements under every exchange schedule.
#include "base/error.h"
#include "coupling_scene.h"
#include "hard_case.h"

namespace trackbed::hard {
namespace {

using namespace coupling;

// A cube thrown at an elastic block that is held at its base.
World thrown_at_block(const Setting& set, int cells, dem::StepContext& c) {
  World w;
  w.exchange.schedule = schedule_named(set.schedule);
  w.exchange.grain_steps = set.grain_steps;
  set_materials(w, 1e8, 0);
  add_grain(w, dem::make_box({.05, .05, .05}), 2600, {.003, .002, .0251},
            Quat(Eigen::AngleAxisd(.02, Vec3(1, 2, 0).normalized())));
  w.surfaces.push_back(make_surface(
      "block", 0, .01, 0, Vec3::Zero(),
      std::make_unique<fem::ElasticBody>(block(5e7, {.2, .2, .1}, {cells, cells, cells}))));
  w.bodies.v[0].z() = -.5;
  c = context(set.share * dem::expected_limit(w.bodies, w.shapes, w.materials, {1, 1}).dt,
              Vec3::Zero());
  start(w, c);
  return w;
}

Measured ledger(const Setting& set) {
  dem::StepContext c;
  try {
    World w = thrown_at_block(set, 3, c);
    const double before = w.start.total();
    double worst = 0;
    for (int k = 0; k < 200; ++k) {
      run(w, c, set.schedule == "several_steps" ? set.grain_steps : 4);
      worst = std::max(worst, std::abs(closure(w.start, stores(w, c.gravity), flows(w))));
    }
    // What the schedules promise: predicted, explicit and iterated at small steps.
    const bool promised = set.share <= kPromisedShare && set.schedule != "lagged" &&
                          set.grain_steps * set.share <= kPromisedShare;
    return {worst / before, 1e-3, promised};
  } catch (const std::exception&) {  // refused: an answer too
    return {0, 1e-3, false};
  }
}

// From cells four times as large as the grain to eight a grain: forces on nodes add up to the
// grain's.
Measured resultants(const Setting& set) {
  double worst = 0;
  for (const int cells : {1, 4, 16}) {
    dem::StepContext c;
    try {
      World w = thrown_at_block(set, cells, c);
      for (int k = 0; k < 200 && count_contacts(w) == 0; ++k) run(w, c, 1);
      run(w, c, 5);
      if (count_contacts(w) == 0) return {NAN, 1e-13, false};  // bounced within an exchange
      Vec3 sum = w.bodies.force[0];
      for (int i = 0; i < w.surfaces[0].patch.carried; ++i) sum += w.surfaces[0].patch.force[i];
      worst = std::max(worst, sum.norm() / w.bodies.force[0].norm());
    } catch (const std::exception&) {
      return {0, 1e-13, false};
    }
  }
  return {worst, 1e-13};
}

}  // namespace

const std::vector<Case>& coupled_cases() {
  static const std::vector<Case> cases{
      {"cube thrown at an elastic block", "the ledger closes", "share of the energy", "none",
       Over::schedules, true, false, ledger},
      {"elements coarser and finer than the grain", "resultants are kept", "relative difference",
       "none", Over::schedules, false, false, resultants}};
  return cases;
}

}  // namespace trackbed::hard
