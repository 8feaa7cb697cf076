// Checkpoints, threads, and changes of which bodies there are.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "coupling_scene.h"
#include "tests/scratch_folder.h"
#include "world_state.h"

namespace trackbed::coupling {
namespace {

const Vec3 kGravity(0, 0, -9.81);
constexpr double kStep = 4e-5;

dem::StepContext damped() {
  dem::StepContext c = context(kStep, kGravity);
  c.local_damping = .3;
  return c;
}

// Falls fast, so that the grains are on the subgrade and on each other soon.
void throw_down(World& w) {
  for (int i = 0; i < w.bodies.grains; ++i) w.bodies.v[i] = {.3, 0, -1};
}

// Until three grains and some pairs touch at once.
void run_until_touching(World& w, const dem::StepContext& c) {
  for (int k = 0; k < 10000; ++k) {
    run(w, c, 1);
    if (dem::count_contacts(w.surfaces[0].contacts) > 2 && dem::count_contacts(w.pairs) > 1) return;
  }
  FAIL() << "hardly anything touches";
}

class Checkpoint : public testing::Test, public ScratchFolder {};

TEST_F(Checkpoint, goes_on_bit_by_bit) {
  const std::string path = file("checkpoint.h5");
  World w = bed(3, 2);
  throw_down(w);
  const dem::StepContext c = damped();
  start(w, c);
  run_until_touching(w, c);
  save(w, path);
  run(w, c, 700);

  World again = bed(3, 2);
  for (Surface& s : again.surfaces) s.structure->set_step(kStep);
  load(again, path);
  run(again, c, 700);
  EXPECT_EQ(differing(w, again, kGravity), "");
}

TEST_F(Checkpoint, truncated_is_named) {
  const std::string path = file("checkpoint.h5");
  World w = bed(2, 1);
  const dem::StepContext c = context(kStep, kGravity);
  start(w, c);
  run(w, c, 3);
  save(w, path);
  const auto size = std::filesystem::file_size(path);
  for (const double share : {.97, .5, .1, 0.}) {
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(share * size));
    World other = bed(2, 1);
    try {
      load(other, path);
      FAIL() << "accepted at " << share;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(path), std::string::npos) << e.what();
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_THROW(load(w, path), InputError);
}

TEST_F(Checkpoint, of_another_scene_is_refused) {
  const std::string path = file("checkpoint.h5");
  World w = bed(2, 1);
  start(w, context(kStep, kGravity));
  save(w, path);
  World none = bed(2, 1);
  none.surfaces.clear();
  EXPECT_THROW(load(none, path), InputError);
  World finer = bed(2, 1);
  finer.surfaces.clear();
  finer.surfaces.push_back(
      make_surface("subgrade", 0, .01, .05, Vec3::Zero(),
                   std::make_unique<fem::ElasticBody>(block(5e7, {.12, .12, .15}, {6, 6, 2}))));
  EXPECT_THROW(load(finer, path), InputError);
}

// What is on disk stays whole until the new file is.
TEST_F(Checkpoint, leaves_the_old_one_until_done) {
  const std::string path = file("checkpoint.h5");
  World w = bed(2, 1);
  start(w, context(kStep, kGravity));
  save(w, path);
  {
    ArchiveWriter archive(path);
    write_world(archive, w);  // no commit
  }
  World again = bed(2, 1);
  load(again, path);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  EXPECT_THROW(ArchiveWriter("/nowhere/checkpoint.h5"), RunError);
}

TEST(Edit, keeps_contacts_of_what_remains) {
  World w = bed(3, 2);
  throw_down(w);
  const dem::StepContext c = damped();
  start(w, c);
  run_until_touching(w, c);
  const std::vector<Vec3> forces = w.bodies.force;
  // Grains in reverse order, bodies as they are.
  std::vector<int> order;
  for (int i = w.bodies.grains - 1; i >= 0; --i) order.push_back(i);
  for (int i = w.bodies.grains; i < w.bodies.size(); ++i) order.push_back(i);
  reorder(w, order, w.bodies.grains);
  for (int p = 0; p < w.pairs.size(); ++p) EXPECT_LT(w.pairs.a[p], w.pairs.b[p]);
  dem::StepContext still = c;
  still.dt = 0;
  prepare(w, still);
  double largest = 0;
  for (const Vec3& f : forces) largest = std::max(largest, f.norm());
  ASSERT_GT(largest, 1);
  for (int i = 0; i < w.bodies.size(); ++i)
    EXPECT_LE((w.bodies.force[i] - forces[order[i]]).norm(), 1e-9 * largest) << i;

  // One grain gone: all others keep what they feel but for contacts with it.
  World v = bed(3, 2);
  throw_down(v);
  start(v, c);
  run_until_touching(v, c);
  const int gone = v.surfaces[0].contacts.grain[0];
  std::vector<Vec3> expected = v.bodies.force;
  for (int p = 0; p < v.pairs.size(); ++p) {
    if (!v.pairs.touching[p]) continue;
    if (v.pairs.a[p] == gone) expected[v.pairs.b[p]] += v.pairs.force[p];
    if (v.pairs.b[p] == gone) expected[v.pairs.a[p]] -= v.pairs.force[p];
  }
  expected.erase(expected.begin() + gone);
  remove_bodies(v, {gone});
  prepare(v, still);
  for (int i = 0; i < v.bodies.size(); ++i)
    EXPECT_LE((v.bodies.force[i] - expected[i]).norm(), 1e-9 * largest) << i;
}

// A settled stack on the subgrade feels nothing of a grain that is put in elsewhere.
TEST(Edit, settled_stack_stays_when_a_grain_comes) {
  World w;
  set_materials(w, 1e8, .5);
  for (int k = 0; k < 3; ++k)
    add_grain(w, dem::make_box({.1, .1, .1}), 2600, {.01 * k, 0, .05 + .1 * k}, Quat::Identity(),
              dem::kMoveX | dem::kMoveZ | dem::kTurnY);
  dem::add_box(w.bodies, w.shapes, {-.4, -.3, -.2}, {-.3, .3, 1}, 0, 1, dem::kFixed);
  w.surfaces.push_back(make_surface(
      "soil", 0, .02, .1, Vec3::Zero(),
      std::make_unique<fem::ElasticBody>(block(5e7, {.6, .6, .2}, {6, 6, 2}, true, 500))));
  dem::StepContext c = context(5e-5, kGravity);
  c.local_damping = .6;
  start(w, c);
  run(w, c, 20000);
  const auto fastest = [&](int steps) {
    double most = 0;
    for (int k = 0; k < steps; ++k) {
      run(w, c, 1);
      for (int i = 0; i < 3; ++i) most = std::max(most, w.bodies.v[i].norm());
    }
    return most;
  };
  const double before = fastest(500);
  ASSERT_LT(before, 1e-5);
  const Vec3 friction = w.surfaces[0].contacts.friction[0], top = w.bodies.x[2];
  const dem::GrainShape s = dem::make_grain_shape(dem::make_box({.05, .05, .05}));
  add_grains(w, {s}, {Vec3(-.2, .2, .2)}, {Quat::Identity()}, 2600, 0);
  ASSERT_EQ(w.bodies.grains, 4);
  EXPECT_EQ(w.surfaces[0].contacts.friction[0], friction);
  dem::StepContext still = c;
  still.dt = 0;
  prepare(w, still);
  EXPECT_LE(fastest(500), before + 1e-12);
  EXPECT_LT((w.bodies.x[2] - top).norm(), 1e-7);
  EXPECT_LT(w.bodies.v[3].z(), -.05);  // the new one falls
}

TEST(Step, stops_at_a_place_that_is_no_number) {
  for (const auto what : {&dem::Bodies::v, &dem::Bodies::L}) {
    World w = bed(2, 1);
    const dem::StepContext c = context(kStep, kGravity);
    start(w, c);
    (w.bodies.*what)[2].x() = std::nan("");
    try {
      run(w, c, 1);
      FAIL() << "went on";
    } catch (const RunError& e) {
      EXPECT_NE(std::string(e.what()).find("body 2"), std::string::npos) << e.what();
    }
  }
}

// Limits: a bound of the true one, and near it. Plate flat on a stiff surface: rocking,
// omega^2 = 9/4 k a^2/12 / (m (a^2 + t^2)/12).
TEST(TimeStep, limit_of_a_plate_on_a_surface) {
  World w;
  set_materials(w, 1e8, 0);
  const double m = 1000 * .0008, k = .7522527780636751 * 1e8 * .2;
  add_grain(w, dem::make_box({.2, .2, .02}), 1000, {0, 0, .01 - 1e-5});
  w.surfaces.push_back(
      make_surface("mass", 0, .02, 0, Vec3::Zero(),
                   std::make_unique<fem::ElasticBody>(block(1e16, {.6, .6, .2}, {3, 3, 1}))));
  start(w, context(1e-6, kGravity));
  const double exact = 2 / std::sqrt(2.25 / 1.01 * k / m), limit = measured_limit(w, 1).dt;
  EXPECT_LE(limit, exact);
  // The surface may give way (2), and the stiffness is the law's upper bound (1.2).
  EXPECT_NEAR(limit, exact / std::sqrt(2.4), .03 * exact);
}

}  // namespace
}  // namespace trackbed::coupling
