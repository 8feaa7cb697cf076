#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dem/grading/curve.h"

namespace trackbed::dem {
namespace {

void refused(const std::vector<double>& sieve, const std::vector<double>& passing,
             const std::string& part) {
  try {
    make_curve(sieve, passing);
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

TEST(SieveCurve, RefusesWhatIsNoCurve) {
  refused({}, {}, "no sieves");
  refused({0.016, 0.025}, {0}, "1 percentages for 2 sieves");
  refused({0.016, 0.025}, {50, 40}, "passing falls from 50 % to 40 % at 25 mm");
  refused({0.016, 0.025}, {50, 101}, "101 % passing at 25 mm; 0 to 100 is allowed");
  refused({0.016, 0.025}, {-1, 50}, "-1 % passing at 16 mm");
  refused({0.016, 0.025}, {std::nan(""), 50}, "0 to 100 is allowed");
  refused({0.025, 0.016}, {0, 50}, "sieves must ascend");
  refused({0.016, 0.016}, {0, 50}, "sieves must ascend");
  refused({0, 0.016}, {0, 50}, "must be positive");
  refused({std::nan(""), 0.016}, {0, 50}, "must be positive");
  SieveCurve c = make_curve({0.016, 0.025}, {0, 50});
  c.top = 0.02;
  EXPECT_THROW(validate(c), InputError);
  c.top = 0;
  c.band_min = {0, 60};
  c.band_max = {10, 70};
  EXPECT_THROW(validate(c), InputError);
}

TEST(SieveCurve, ClassesOfTheWideGrading) {
  const auto classes = sieve_classes(named_curve("shao2017_wide"));
  const double share[] = {0, 0, 4, 29, 46, 16, 5};
  ASSERT_EQ(classes.size(), 7u);
  for (int j = 0; j < 7; ++j) EXPECT_DOUBLE_EQ(classes[j].percent, share[j]);
  EXPECT_DOUBLE_EQ(classes[5].low, 0.056);
  EXPECT_DOUBLE_EQ(classes[5].high, 0.063);
  EXPECT_DOUBLE_EQ(classes[6].high, 0.080);  // 5 % above 63 mm end at the next standard sieve
  SieveCurve c = named_curve("shao2017_wide");
  c.top = 0.07;
  EXPECT_DOUBLE_EQ(sieve_classes(c)[6].high, 0.07);
}

TEST(SieveCurve, EveryNamedCurveIsValidAndItsTargetLiesInItsBand) {
  for (const std::string& name : curve_names()) {
    const SieveCurve c = named_curve(name);
    EXPECT_NO_THROW(validate(c)) << name;
    EXPECT_FALSE(c.source.empty()) << name;
    EXPECT_EQ(outside_band(c, c.passing), -1) << name;
    double sum = 0;
    for (const SieveClass& k : sieve_classes(c)) {
      EXPECT_LT(k.low, k.high) << name;
      sum += k.percent;
    }
    EXPECT_NEAR(sum, 100, 1e-12) << name;
  }
  EXPECT_THROW(named_curve("shao2017_wid"), InputError);
}

TEST(SieveCurve, NearestNameIsOffered) {
  try {
    named_curve("arema4a");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'arema_4a'"), std::string::npos) << e.what();
  }
}

TEST(SieveCurve, PassingAndBand) {
  const auto passing = passing_percent({0.01, 0.02, 0.03, 0.04}, {1, 2, 3, 4}, {0.02, 0.035});
  EXPECT_DOUBLE_EQ(passing[0], 30);  // a grain as large as the hole passes
  EXPECT_DOUBLE_EQ(passing[1], 60);
  const SieveCurve c = named_curve("en13450_a");
  EXPECT_EQ(outside_band(c, {0, 1, 30, 70, 100}), -1);
  EXPECT_EQ(outside_band(c, {0, 1, 66, 70, 100}), 2);
  EXPECT_THROW(passing_percent({}, {}, {0.02}), InputError);
}

TEST(SolidVolume, ShaosBox) {
  EXPECT_NEAR(solid_volume(0.6 * 0.3 * 0.35, 1720, 2600), 0.041677, 5e-7);
  EXPECT_NEAR(2600 * solid_volume(0.6 * 0.3 * 0.35, 1720, 2600), 108.36, 5e-3);
  EXPECT_THROW(solid_volume(0.063, 2700, 2600), InputError);
}

}  // namespace
}  // namespace trackbed::dem
