// The stability limit of grains on a body of modes: never above the true one, sharp for two equal
// masses, held at 0.9 of it and left at 1.1 of the true one.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "coupling_scene.h"
#include "fem/modal_structure.h"

namespace trackbed::coupling {
namespace {

constexpr double kGrain = 1, kContact = 4, kDepth = .01;  // mass, spring, depth at rest

struct Mode {
  double mass, omega;  // of the surface as a whole moving by 1
};

// A unit cube, up and down only, on a square that all modes move as a whole; a load on each side
// presses them together. Face on face the contact is a spring, to (depth/1)^4.
World cube_on_modes(const std::vector<Mode>& modes) {
  World w;
  set_materials(w, kContact / .7522527780636751, 0);
  add_grain(w, dem::make_box({1, 1, 1}), kGrain, {0, 0, .5 - kDepth}, dem::Quat::Identity(),
            dem::kMoveZ);
  w.bodies.applied_force[0] = Vec3(0, 0, -kContact * kDepth);
  fem::ModalModel m;
  m.surface = MassOnSpring(1, 0, 2, true).surface();
  fem::ModalLoad load{"up", {0, 0, 1}, std::vector<double>(3 * modes.size())};
  m.shape.assign(12 * modes.size(), 0.);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    m.omega.push_back(modes[k].omega);
    const double shape = 1 / std::sqrt(modes[k].mass);
    for (int i = 0; i < 4; ++i) m.shape[(3 * i + 2) * modes.size() + k] = shape;
    load.shape[2 * modes.size() + k] = shape;
    m.mass += modes[k].mass;
  }
  m.loads = {load};
  m.least_surface_mass = 1e-6;  // of a node: not what counts
  auto body = std::make_unique<fem::ModalStructure>(m);
  body->set_load(0, kContact * kDepth);
  w.surfaces.push_back(make_surface("body", 0, .1, 0, Vec3::Zero(), std::move(body)));
  return w;
}

// M x'' = -K x by leapfrog, each mode with the mass that its step gives it (modal_structure.h).
double true_limit(const std::vector<Mode>& modes) {
  const int n = static_cast<int>(modes.size()) + 1;
  const auto unstable = [&](double dt) {
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(n), mass = Eigen::VectorXd::Constant(n, kGrain);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    pull[0] = 1;
    for (int k = 1; k < n; ++k) {
      const double omega = modes[k - 1].omega, w = std::min(omega, 1 / dt);
      pull[k] = -1 / std::sqrt(modes[k - 1].mass);
      const double half = .5 * w * dt;
      mass[k] = w > 0 ? std::pow(omega / w * half / std::sin(half), 2) : 1;
      K(k, k) = omega * omega;
    }
    K += kContact * pull * pull.transpose();
    const Eigen::VectorXd root = mass.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd A = root.asDiagonal() * K * root.asDiagonal();
    return dt * dt * Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues()[n - 1] > 4;
  };
  double low = 0, high = 10;
  while (high - low > 1e-12) (unstable((low + high) / 2) ? high : low) = (low + high) / 2;
  return low;
}

// Largest excursion in the last tenth of the steps over that in the first.
double growth(const std::vector<Mode>& modes, double dt, int steps) {
  World w = cube_on_modes(modes);
  const dem::StepContext c = context(dt, Vec3::Zero());
  start(w, c);
  w.bodies.v[0].z() = 1e-6;
  const double at = w.bodies.x[0].z();
  double early = 0, late = 0;
  for (int n = 0; n < steps; ++n) {
    advance(w, c, [](World&, double) {});
    const double gap = w.bodies.x[0].z() - at - w.surfaces[0].patch.node[0].z();
    if (n < steps / 10) early = std::max(early, std::abs(gap));
    if (n >= steps - steps / 10) late = std::max(late, std::abs(gap));
    if (std::abs(gap) > .1 * kDepth) return HUGE_VAL;
  }
  return late / early;
}

double bound(const std::vector<Mode>& modes) {
  World w = cube_on_modes(modes);
  start(w, context(1e-3, Vec3::Zero()));
  return measured_limit(w, 1).dt;
}

TEST(Limit, of_a_cube_on_modes) {
  const std::vector<std::vector<Mode>> bodies{
      {{1, 0}}, {{7, 0}}, {{.2, 0}}, {{1, 0}, {3, .5}}, {{1, 0}, {.5, 1.2}}, {{1, 0}, {.3, 50}}};
  for (const auto& modes : bodies) {
    SCOPED_TRACE(testing::Message() << modes[0].mass << ' ' << modes.back().omega);
    const double exact = true_limit(modes), limit = bound(modes);
    EXPECT_LT(limit, 1.0001 * exact);
    EXPECT_GT(limit, .3 * exact);  // least for a soft mode that only follows
    EXPECT_LT(growth(modes, .9 * limit, 5000), 1.5);
    EXPECT_GT(growth(modes, 1.1 * exact, 500), 1e3);
  }
}

// Their difference is the motion, so that splitting the contact loses nothing; the law itself calls
// a face on a face 6/5 as stiff as it is, for what edges may make of it.
TEST(Limit, is_sharp_for_two_equal_masses) {
  World w = cube_on_modes({{kGrain, 0}});
  start(w, context(1e-3, Vec3::Zero()));
  const double k = w.surfaces[0].contacts.stiffness[0];
  EXPECT_NEAR(k, 1.2 * kContact, 1e-6);
  EXPECT_NEAR(measured_limit(w, 1).dt, 2 / std::sqrt(2 * k / kGrain), 1e-12);
  EXPECT_NEAR(true_limit({{kGrain, 0}}), 2 / std::sqrt(2 * kContact / kGrain), 1e-9);
}

// Predicted, then moved elsewhere by a solve: a third of the step, unless the exchange is iterated.
TEST(Limit, is_a_third_where_a_solve_moves_what_was_predicted) {
  const auto limit = [](bool verlet, Schedule schedule) {
    World w = cube_on_modes({{1, 0}});
    w.surfaces.clear();
    w.surfaces.push_back(make_surface("body", 0, .1, 0, Vec3::Zero(),
                                      std::make_unique<MassOnSpring>(kGrain, 1e-6, 2, verlet)));
    w.exchange.schedule = schedule;
    start(w, context(1e-3, Vec3::Zero()));
    return measured_limit(w, 1).dt;
  };
  const double whole = limit(true, Schedule::predicted);
  EXPECT_LT(whole, 2 / std::sqrt(2 * 1.2 * kContact / kGrain));  // the lightest node's
  EXPECT_NEAR(limit(false, Schedule::predicted), whole / 3, 1e-9);
  EXPECT_NEAR(limit(false, Schedule::iterated), whole, 1e-9);
}

// A grain between others and a surface: the surface's contact counts with those of the pairs.
TEST(Limit, counts_the_surface_with_the_pairs) {
  const auto limit = [](bool surface, bool above) {
    World w = cube_on_modes({{1e9, 0}});
    if (above)
      add_grain(w, dem::make_box({1, 1, 1}), 1e9, {0, 0, 1.5 - 2 * kDepth}, dem::Quat::Identity(),
                dem::kMoveZ);
    if (!surface) w.surfaces.clear();
    start(w, context(1e-3, Vec3::Zero()));
    return std::pow(2 / measured_limit(w, 1).dt, 2);
  };
  const double both = limit(true, true), below = limit(true, false), above = limit(false, true);
  EXPECT_NEAR(below, 2 * 1.2 * kContact / kGrain, 1e-3);
  EXPECT_NEAR(both, below + above, 1e-9 * both);
}

}  // namespace
}  // namespace trackbed::coupling
