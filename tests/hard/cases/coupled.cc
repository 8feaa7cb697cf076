// Grains on finite elements under every exchange schedule.
#include "base/error.h"
#include "coupling_scene.h"
#include "hard_case.h"

namespace trackbed::hard {
namespace {

using namespace coupling;

// A cube thrown at an elastic block that is held at its base.
World thrown_at_block(const Setting& set, int cells, dem::StepContext& c, double young = 5e7,
                      double width = .2) {
  World w;
  w.exchange.schedule = schedule_named(set.schedule);
  w.exchange.grain_steps = set.grain_steps;
  set_materials(w, 1e8, 0);
  add_grain(w, dem::make_box({.05, .05, .05}), 2600, {.003, .002, .0251},
            Quat(Eigen::AngleAxisd(.02, Vec3(1, 2, 0).normalized())));
  w.surfaces.push_back(make_surface("block", 0, .01, 0, Vec3::Zero(),
                                    std::make_unique<fem::ElasticBody>(block(
                                        young, {width, width, width / 2}, {cells, cells, cells}))));
  w.bodies.v[0].z() = -.5;
  c = context(set.share * dem::expected_limit(w.bodies, w.shapes, w.materials, {1, 1}).dt,
              Vec3::Zero());
  start(w, c);
  return w;
}

bool is_promised(const Setting& set) {  // predicted, explicit and iterated at small steps
  return set.share <= kPromisedShare && set.schedule != "lagged" &&
         set.grain_steps * set.share <= kPromisedShare;
}

// Calls look(world) some 200 times while it hits and leaves; NaN where the schedule is refused.
template <class Look>
bool follow(const Setting& set, double young, dem::StepContext& c, const Look& look) {
  try {
    World w = thrown_at_block(set, 3, c, young);
    look(w);
    // At least as many grain steps as of one a schedule, and 20 exchanges.
    const int exchanges = std::max(20, 800 / set.grain_steps);
    for (int k = 0; k < exchanges; ++k) {
      run(w, c, 1);
      look(w);
    }
    return true;
  } catch (const std::exception&) {  // refused: an answer too
    return false;
  }
}

Measured ledger(const Setting& set) {
  dem::StepContext c;
  double worst = 0, before = 0;
  const bool ran = follow(set, 5e7, c, [&](World& w) {
    before = w.start.total();
    worst = std::max(worst, std::abs(closure(w.start, stores(w, c.gravity), flows(w))));
  });
  return {ran ? worst / before : 0, 1e-3, ran && is_promised(set)};
}

// Ground a thousand times softer than the contact: energy of grain, contact and block over that of
// the start.
Measured soft_ground(const Setting& set) {
  dem::StepContext c;
  double most = 0, before = 0;
  const bool ran = follow(set, 1e5, c, [&](World& w) {
    before = w.start.total();
    most = std::max(most, stores(w, c.gravity).total());
  });
  return {ran ? most / before - 1 : 0, 1e-3, ran && is_promised(set)};
}

// From cells four times as large as the grain to eight a grain: forces on nodes add up to the
// grain's.
Measured resultants(const Setting& set) {
  double worst = 0;
  for (const auto& [cells, width] : {std::pair{1, .2}, {4, .2}, {16, .1}}) {
    dem::StepContext c;
    try {
      World w = thrown_at_block(set, cells, c, 5e7, width);
      for (int k = 0; k < 200 && count_contacts(w) == 0; ++k) run(w, c, 1);
      run(w, c, 5);
      if (count_contacts(w) == 0) return {NAN, 1e-14, false};  // bounced within an exchange
      Vec3 sum = w.bodies.force[0];
      for (int i = 0; i < w.surfaces[0].patch.carried; ++i) sum += w.surfaces[0].patch.force[i];
      worst = std::max(worst, sum.norm() / w.bodies.force[0].norm());
    } catch (const std::exception&) {
      return {0, 1e-14, false};
    }
  }
  return {worst, 1e-14};
}

}  // namespace

const std::vector<Case>& coupled_cases() {
  static const std::vector<Case> cases{
      {"cube thrown at an elastic block", "the ledger closes", "share of the energy", "none",
       Over::schedules, true, false, ledger},
      {"cube thrown at ground 1000 times softer than its contact", "no energy is gained",
       "share of the energy", "none", Over::schedules, true, false, soft_ground},
      {"elements coarser and finer than the grain", "resultants are kept", "relative difference",
       "none", Over::schedules, false, false, resultants}};
  return cases;
}

}  // namespace trackbed::hard
