#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "dem/grading/draw.h"
#include "dem/grading/sieve_size.h"
#include "dem/grain/library.h"
#include "dem/grain/shape_indices.h"

namespace trackbed::dem {
namespace {

const double shaos_volume = 0.6 * 0.3 * 0.35 * 1720 / 2600;

GrainShape sized_box(const Vec3& edges, double sieve) {
  GrainShape s = make_grain_shape(make_box(edges));
  s.sieve_size = sieve;
  return s;
}
std::vector<GrainShape> boxes() {  // V = 0.6 d3
  return {sized_box({1, 1, 0.6}, 1)};
}

TEST(GradationDraw, MeetsEveryNamedCurveWithinOnePercentPerClass) {
  LibraryParameters lp;
  lp.count = 60;
  const auto library = make_library(lp);
  for (const std::string& name : curve_names()) {
    const SieveCurve curve = named_curve(name);
    DrawParameters p;
    p.volume = shaos_volume;
    const GradationDraw d = draw_gradation(curve, library, p);
    EXPECT_NEAR(d.volume / p.volume, 1, 0.01) << name;
    double volume = 0;
    for (const DrawnGrain& g : d.grains) {
      volume += g.volume;
      EXPECT_NEAR(g.scale * library[g.shape].sieve_size, g.sieve, 1e-12);
      EXPECT_NEAR(std::pow(g.scale, 3) * library[g.shape].volume, g.volume, 1e-15);
    }
    EXPECT_NEAR(volume, d.volume, 1e-12) << name;
    int count = 0;
    for (const DrawnClass& c : d.classes) {
      EXPECT_NEAR(c.achieved_volume, c.target_volume, 0.01 * p.volume) << name;
      count += c.count;
      const auto inside = [&](const DrawnGrain& g) { return g.sieve > c.low && g.sieve <= c.high; };
      EXPECT_EQ(std::count_if(d.grains.begin(), d.grains.end(), inside), c.count) << name;
    }
    EXPECT_EQ(count, int(d.grains.size()));
    for (size_t i = 0; i < curve.sieve.size(); ++i)
      EXPECT_NEAR(d.achieved_passing[i], curve.passing[i], 1) << name;
    EXPECT_EQ(outside_band(curve, d.achieved_passing, 0.05), -1) << name;
  }
}

// By hand: about 730 grains with V = 0.6 d3, counted class by class, where the paper counts 984.
TEST(GradationDraw, CountsOfTheWideGrading) {
  DrawParameters p;
  p.volume = shaos_volume;
  const GradationDraw d = draw_gradation(named_curve("shao2017_wide"), boxes(), p);
  EXPECT_NEAR(d.grains.size(), 730, 15);
  for (const DrawnClass& c : d.classes) {
    const double middle = 0.5 * (c.low + c.high);
    EXPECT_NEAR(c.count, c.target_volume / (0.6 * std::pow(middle, 3)), 0.1 * c.count + 2);
  }
}

TEST(GradationDraw, SizesSpreadOverTheirClass) {
  DrawParameters p;
  p.volume = shaos_volume;
  const GradationDraw d = draw_gradation(named_curve("shao2017_small"), boxes(), p);
  double lower = 0;  // mass below the middle of the class: half
  for (const DrawnGrain& g : d.grains)
    if (g.sieve <= 0.03025) lower += g.volume;
  EXPECT_NEAR(lower / d.volume, 0.5, 0.03);
}

TEST(GradationDraw, SameSeedSameGrainsAndOrderIsShuffled) {
  const std::vector<GrainShape> library = {sized_box({1, 1, 0.6}, 1), sized_box({1, 1, 1}, 1),
                                           sized_box({1, 1, 1.5}, 1)};
  DrawParameters p;
  p.volume = shaos_volume;
  const SieveCurve curve = named_curve("shao2017_wide");
  const GradationDraw a = draw_gradation(curve, library, p), b = draw_gradation(curve, library, p);
  ASSERT_EQ(a.grains.size(), b.grains.size());
  for (size_t i = 0; i < a.grains.size(); ++i) {
    EXPECT_EQ(a.grains[i].shape, b.grains[i].shape);
    EXPECT_EQ(a.grains[i].sieve, b.grains[i].sieve);
  }
  p.seed = 2;
  const GradationDraw c = draw_gradation(curve, library, p);
  EXPECT_NE(a.grains[0].sieve, c.grains[0].sieve);
  int descents = 0;
  for (size_t i = 1; i < a.grains.size(); ++i)
    descents += a.grains[i].sieve < a.grains[i - 1].sieve;
  EXPECT_NEAR(descents, a.grains.size() / 2., a.grains.size() / 10.);
  int uses[3] = {};
  for (const DrawnGrain& g : a.grains) ++uses[g.shape];  // without repetition: equally often
  EXPECT_LE(*std::max_element(uses, uses + 3) - *std::min_element(uses, uses + 3), 12);
}

TEST(GradationDraw, UnscaledShapesKeepTheirSize) {
  std::vector<GrainShape> library;
  for (double d = 0.026; d < 0.08; d += 0.001) library.push_back(sized_box({d, d, 0.6 * d}, d));
  DrawParameters p;
  p.volume = shaos_volume;
  p.scale = false;
  const GradationDraw d = draw_gradation(named_curve("shao2017_wide"), library, p);
  for (const DrawnGrain& g : d.grains) EXPECT_EQ(g.scale, 1);
  for (const DrawnClass& c : d.classes)
    EXPECT_NEAR(c.achieved_volume, c.target_volume, 0.01 * p.volume);
}

TEST(GradationDraw, NeedleAndFlakyShares) {
  LibraryParameters lp;
  lp.count = 90, lp.needles = 20, lp.flakes = 20;
  const auto library = make_library(lp);
  const SieveCurve wide = named_curve("shao2017_wide");
  for (const auto& [needle, flaky] : {std::pair(5., 0.), std::pair(0., 20.), std::pair(10., 15.)})
    for (bool scale : {true, false}) {
      std::vector<GrainShape> shapes;
      for (size_t k = 0; k < library.size(); ++k)
        for (double d : {0.03, 0.04, 0.05, 0.06, 0.07})
          if (scale ? d == 0.03 : true) shapes.push_back(scaled(library[k], scale ? 1 : d));
      DrawParameters p;
      p.volume = shaos_volume;
      p.scale = scale;
      p.needle_share = needle, p.flaky_share = flaky;
      const GradationDraw d = draw_gradation(wide, shapes, p);
      double is_needle = 0, is_flaky = 0;
      for (const DrawnGrain& g : d.grains) {
        const ShapeIndices s = shape_indices(shapes[g.shape].body);
        const double size = shapes[g.shape].sieve_size;
        EXPECT_FALSE(s.diameter > 1.8 * size && s.width < 0.6 * size);
        if (s.diameter > 1.8 * size) is_needle += 100 * g.volume / d.volume;
        if (s.width < 0.6 * size) is_flaky += 100 * g.volume / d.volume;
      }
      EXPECT_NEAR(is_needle, needle, p.tolerance);
      EXPECT_NEAR(is_flaky, flaky, p.tolerance);
      EXPECT_NEAR(d.needle_percent, is_needle, 1e-9);
      EXPECT_NEAR(d.flaky_percent, is_flaky, 1e-9);
      for (size_t i = 0; i < wide.sieve.size(); ++i)
        EXPECT_NEAR(d.achieved_passing[i], wide.passing[i], 1);
    }
}

void refused(const SieveCurve& curve, const std::vector<GrainShape>& library,
             const DrawParameters& p, const std::string& part) {
  try {
    draw_gradation(curve, library, p);
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

TEST(GradationDraw, RefusesImpossibleRequests) {
  const SieveCurve wide = named_curve("shao2017_wide");
  DrawParameters p;
  p.volume = shaos_volume;
  refused(wide, {}, p, "library is empty");
  refused(wide, {make_grain_shape(make_box({1, 1, 1}))}, p, "not sized");
  DrawParameters none = p;
  none.volume = 0;
  refused(wide, boxes(), none, "must be positive");
  none.volume = std::nan("");
  refused(wide, boxes(), none, "must be positive");
  DrawParameters unscaled = p;
  unscaled.scale = false;
  refused(wide, {sized_box({0.04, 0.04, 0.04}, 0.04)}, unscaled,
          "no shape of the library falls into class 25 to 35.5 mm");
  DrawParameters little = p;
  little.volume = 1e-3;  // 5 % of a litre is less than half of a grain of 63 to 80 mm
  refused(wide, boxes(), little, "class 63 to 80 mm misses");
  DrawParameters needles = p;
  needles.needle_share = 5;
  refused(wide, boxes(), needles, "needles are asked for, but the library holds none");
  needles.flaky_share = 96;
  refused(wide, boxes(), needles, "must be 0 to 100 % together");
}

}  // namespace
}  // namespace trackbed::dem
