// True triaxial test on a block between six frictionless walls, without gravity: the floor is held,
// four side walls keep the confining stress s3, the top keeps it too while the specimen
// consolidates and then comes down at a constant speed. Stresses are forces over the present areas,
//   s1 = mean of top and floor, s3 = mean of the four sides,
//   axial strain = 1 - H/H0, volumetric strain = 1 - V/V0 (positive when it shrinks),
// H0, V0 those of the consolidated specimen.
#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/grain_tests/walls.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/materials.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

// In pairs: the wall at the low end of an axis and the one at its high end.
enum Wall { kSides, kBottom = 4, kTopWall = 5, kAllWalls = 6 };
constexpr double kClearance = 1e-4;  // of the top over the highest grain [m]

void fill_space(Run& run) {
  begin_specimen(run);
  GrainTestState& t = run.test;
  t.high.z() = highest_grain(run, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL) + kClearance;
  const Vec3 beyond = Vec3::Constant(wall_thickness);
  for (int k = 0; k < kAllWalls; ++k) {
    Vec3 low = t.low - beyond, high = t.high + beyond;
    (k % 2 == 0 ? high : low)[k / 2] = (k % 2 == 0 ? t.low : t.high)[k / 2];
    add_test_wall(run, low, high, kMirror);
  }
}

/// Present lengths of the inner space [m].
Vec3 lengths(const Run& run) {
  Vec3 l = run.test.high - run.test.low;
  for (int d = 0; d < 3; ++d) l[d] += wall_travel(run, 2 * d + 1)[d] - wall_travel(run, 2 * d)[d];
  return l;
}

Vec3 inward(int k) { return (k % 2 == 0 ? 1 : -1) * Vec3::Unit(k / 2); }

/// Stress on each wall, compression positive [Pa].
std::vector<double> wall_stresses(const Run& run) {
  const Vec3 l = lengths(run);
  std::vector<double> stress;
  for (int k = 0; k < kAllWalls; ++k)
    stress.push_back(-run.world.bodies.force[wall(run, k)].dot(inward(k)) * l[k / 2] / l.prod());
  return stress;
}

void confine(Run& run, const std::vector<double>& stress, int from, int to) {
  const Vec3 l = lengths(run);
  for (int k = from; k < to; ++k) {
    const double area = l.prod() / l[k / 2];
    drive_wall(run, k, k, inward(k), test_stress(run) * area, stress[k] * area);
  }
}

Stage consolidation(const Scene& s, double stress) {
  Stage stage = bed_stage(s, stress_name("consolidation", stress), s.test.consolidation_time,
                          s.contact.packing_damping);
  stage.ledger = false;  // what rings down here is more than the work that is put in
  stage.gravity = false;
  stage.enter = fill_space;
  stage.control = [](Run& run, const Stage& now) {
    const std::vector<double> stresses = wall_stresses(run);
    confine(run, stresses, kSides, kBottom);
    confine(run, stresses, kTopWall, kAllWalls);
    std::vector<double> errors;
    for (const double p : stresses) errors.push_back(p / test_stress(run) - 1);
    return consolidated(run, now, errors);
  };
  return stage;
}

Stage compression(const Scene& s, double stress) {
  Stage stage = bed_stage(s, stress_name("compression", stress),
                          1.01 * s.test.largest_strain / s.test.strain_rate, s.contact.damping);
  stage.gravity = false;
  stage.enter = [](Run& run) {
    run.test.steps = 0;
    run.test.lengths = lengths(run);
    run.world.bodies.v[wall(run, kTopWall)] =
        Vec3(0, 0, -run.scene.test.strain_rate * run.test.lengths.z());
  };
  stage.control = [](Run& run, const Stage&) {
    const std::vector<double> p = wall_stresses(run);
    confine(run, p, kSides, kBottom);
    const Vec3 l = lengths(run), l0 = run.test.lengths;
    const double axial = 1 - l.z() / l0.z(), volumetric = 1 - l.prod() / l0.prod();
    const bool last =
        add_to_row(run,
                   {run.world.time, axial, (p[kBottom] + p[kTopWall]) / 2, (p[0] + p[1]) / 2,
                    (p[2] + p[3]) / 2, volumetric, 1 - run.test.solid / l.prod()},
                   axial / run.scene.test.largest_strain);
    if (last) ++run.test.specimen;
    return last;
  };
  return stage;
}

}  // namespace

std::vector<Stage> triaxial_stages(const Scene& s) {
  std::vector<Stage> stages;
  for (const double stress : s.test.stresses) {
    stages.push_back(consolidation(s, stress));
    stages.push_back(compression(s, stress));
  }
  return stages;
}

}  // namespace trackbed::apps
