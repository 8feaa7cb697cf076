// The friction path's search on beds whose n(mu) is a formula, and on real grains.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "dem/packing/friction_path.h"
#include "dem/packing/packed_grains.h"
#include "packing_bed.h"

namespace trackbed::dem {
namespace {

// Jin's two ends and a curve between that is steep where friction is small.
double jin(double mu) { return 0.3492 + (0.4160 - 0.3492) * std::pow(mu / 0.8, 0.7); }

FrictionPathSettings settings(double porosity, double density) {
  FrictionPathSettings s;
  s.friction = {0.8, 0.6, 0.4, 0.2, 0.1, 0};
  s.porosity = porosity, s.relative_density = density;
  s.tolerance = 1e-5;
  s.most_trials = 30;
  return s;
}

struct Search {
  std::vector<FrictionPoint> points;
  double porosity = 0;
};

// n depends on the friction and on the bed it was made from: never looser than that. A bed that is
// stopped on its way ends `creep` beyond the stop.
Search search(const FrictionPathSettings& s, const std::function<double(double)>& n,
              double creep = 0) {
  Search result;
  result.points.push_back({-1, s.friction[0], n(s.friction[0]), 0});
  for (;;) {
    const FrictionStep step = next_step(s, result.points);
    if (step.done) {
      result.porosity = result.points[step.point].porosity;
      return result;
    }
    const FrictionPoint& from = result.points.at(step.point);
    EXPECT_LT(step.friction, from.friction) << "friction must fall";
    const double end = std::min(from.porosity, n(step.friction));
    const double porosity = step.stop_at > 0 ? std::max(end, step.stop_at - creep) : end;
    const double friction = step.stop_at > 0 ? from.friction : step.friction;
    result.points.push_back({step.point, friction, porosity, step.stop_at});
    if (result.points.size() > 100) throw std::runtime_error("search without end");
  }
}

std::string complaint(const FrictionPathSettings& s, const std::function<double(double)>& n,
                      double creep = 0) {
  try {
    search(s, n, creep);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(FrictionPath, finds_every_porosity_of_the_range) {
  for (int k = 0; k <= 40; ++k) {
    const double wanted = 0.3492 + (0.4160 - 0.3492) * k / 40;
    const Search found = search(settings(wanted, -1), jin);
    EXPECT_NEAR(found.porosity, wanted, 1e-5);
    EXPECT_LT(found.points.size(), 16u);
  }
}

// Jin's own sample: relative density 0.5 is a porosity of 0.3844; his 0.3904 is 0.409.
TEST(FrictionPath, relative_density_is_that_of_void_ratios) {
  EXPECT_NEAR(porosity_at(0.5, 0.4160, 0.3492), 0.3844, 5e-5);
  EXPECT_NEAR(relative_density_at(0.3904, 0.4160, 0.3492), 0.409, 5e-4);
  const Search found = search(settings(-1, 0.5), jin);
  EXPECT_NEAR(found.porosity, 0.3844, 5e-5);
  EXPECT_NEAR(search(settings(-1, 0), jin).porosity, 0.4160, 1e-9);
  EXPECT_EQ(search(settings(-1, 0), jin).points.size(), 1u) << "the deposit is the loosest bed";
  EXPECT_NEAR(search(settings(-1, 1), jin).porosity, 0.3492, 1e-9);
}

TEST(FrictionPath, an_unreachable_porosity_is_told_the_range) {
  for (const double wanted : {0.34, 0.43}) {
    const std::string text = complaint(settings(wanted, -1), jin);
    EXPECT_NE(text.find("cannot be reached"), std::string::npos) << text;
    EXPECT_NE(text.find("0.3492"), std::string::npos) << text;
    EXPECT_NE(text.find("0.4160"), std::string::npos) << text;
  }
}

// No friction leads to a porosity between 0.37 and 0.40: the bed is stopped on its way.
TEST(FrictionPath, a_porosity_that_the_bed_jumps_over_is_reached_by_stopping_it) {
  const auto jump = [](double mu) { return mu > 0.33 ? 0.40 : 0.37; };
  FrictionPathSettings s = settings(0.385, -1);
  s.most_trials = 6;
  for (const double creep : {0.0, 2e-3, 1e-2}) {
    const Search found = search(s, jump, creep);
    EXPECT_NEAR(found.porosity, 0.385, 1e-5);
    EXPECT_EQ(found.points.back().friction, 0.4) << "it rests with the friction it had before";
    EXPECT_LE(found.points.size(), 4u + 6 + 2);
  }
}

TEST(FrictionPath, a_bed_that_cannot_be_stopped_is_told_both_sides) {
  const auto jump = [](double mu) { return mu > 0.33 ? 0.40 : 0.37; };
  const std::string text = complaint(settings(0.385, -1), jump, 1);
  EXPECT_NE(text.find("does not stop"), std::string::npos) << text;
  EXPECT_NE(text.find("0.4000"), std::string::npos) << text;
  EXPECT_NE(text.find("0.3700"), std::string::npos) << text;
}

// Scatter of a small sample: a bed may come to rest a little looser than the one it came from.
TEST(FrictionPath, finds_the_porosity_in_scatter) {
  int call = 0;
  const auto noisy = [&](double mu) { return jin(mu) + 5e-4 * std::sin(17. * ++call); };
  FrictionPathSettings s = settings(0.384, -1);
  s.tolerance = 1e-3;
  EXPECT_NEAR(search(s, noisy).porosity, 0.384, 1e-3);
}

TEST(FrictionPath, bad_settings_are_refused) {
  FrictionPathSettings s = settings(0.38, -1);
  EXPECT_NO_THROW(validate(s));
  s.friction = {0.8, 0.8, 0};
  EXPECT_THROW(validate(s), InputError);
  EXPECT_THROW(validate(settings(-1, -1)), InputError);
  EXPECT_THROW(validate(settings(0.38, 0.5)), InputError);
  EXPECT_THROW(validate(settings(-1, 1.1)), InputError);
}

// Simple cubic arrangement of cubes of edge a at distance a + g: n = 1 - (a/(a+g))^3, height m
// (a+g).
TEST(Bed, porosity_and_height_of_a_cubic_arrangement_are_exact) {
  for (const double gap : {0.0, 0.004, 0.03}) {
    const double a = 0.05, pitch = a + gap;
    const int m = 4;
    Scene s(1e8, 0.5);
    for (int i = 0; i < m * m * m; ++i)
      s.add_block({a, a, a}, 2600,
                  pitch * Vec3(i % m + 0.5, i / m % m + 0.5, i / (m * m) + 0.5) + Vec3(0, 0, 0.2));
    const BedMeasure bed = measure_bed(s.bodies, s.shapes, std::pow(m * pitch, 2), 0.2);
    EXPECT_NEAR(bed.height, m * pitch, 1e-12);
    EXPECT_NEAR(bed.porosity, 1 - std::pow(a / pitch, 3), 1e-12);
    EXPECT_NEAR(bed.solid, 64 * a * a * a, 1e-15);
  }
}

TEST(Equilibrium, share_of_a_block_on_the_floor) {
  Scene s(1e8, 0.5);
  s.add_block({.1, .1, .1}, 2600, {0, 0, .05 - 1e-6});
  s.add_floor(1, .2);
  s.context.dt = 1e-5;
  s.prepare();
  // One contact, force F on the block: the resultant is |F - m g|.
  const double weight = s.bodies.mass[0] * 9.81, push = s.bodies.force[0].z();
  EXPECT_GT(push, 0);
  EXPECT_NEAR(unbalanced_share(s.bodies, s.pairs, s.context.gravity),
              std::abs(push - weight) / push, 1e-9);
  s.bodies.x[0].z() = 1;
  s.prepare();
  EXPECT_TRUE(std::isinf(unbalanced_share(s.bodies, s.pairs, s.context.gravity)));
}

// Real grains down the rungs: each bed denser than the one before.
TEST(FrictionPath, grains_become_denser_as_friction_falls_and_the_search_finds_what_is_between) {
  FrictionPathSettings s;
  s.friction = {0.8, 0.3, 0};
  s.relative_density = 0.5;
  s.tolerance = 1e-2;  // forty grains move in jumps
  std::vector<RealBed> kept{RealBed(0.8)};
  std::vector<FrictionPoint> points{{-1, 0.8, kept[0].porosity(), 0}};
  for (;;) {
    const FrictionStep step = next_step(s, points);
    if (step.done) {
      const double wanted = porosity_at(0.5, points[0].porosity, points[2].porosity);
      EXPECT_NEAR(points[step.point].porosity, wanted, s.tolerance);
      break;
    }
    RealBed bed = kept[step.point];
    const double before = points[step.point].friction;
    const double porosity = bed.settle(step.friction, step.stop_at, before);
    EXPECT_LT(porosity, points[step.point].porosity + 2e-4) << "friction " << step.friction;
    points.push_back(
        {step.point, step.stop_at > 0 ? before : step.friction, porosity, step.stop_at});
    kept.push_back(bed);
  }
  EXPECT_GT(points[0].porosity - points[2].porosity, 0.02) << "a range worth the name";
}

}  // namespace
}  // namespace trackbed::dem
