// Every hard case at its first setting; the command hard_cases runs all settings.
#include <gtest/gtest.h>

#include <ostream>

#include "cases/hard_case.h"

namespace trackbed::hard {

// In ctest's names.
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

namespace {

class HardCase : public testing::TestWithParam<Case> {};

TEST_P(HardCase, holds) {
  const Case& c = GetParam();
  const Measured m = c.run(settings(c)[0]);
  std::printf("%-50s %10.2e of %.2e (%s)\n", c.name.c_str(), m.value, m.bound, c.unit.c_str());
  EXPECT_TRUE(m.judged);
  EXPECT_LE(m.value, m.bound) << c.must;
}

std::vector<Case> quick() {
  std::vector<Case> list;
  for (const Case& c : all_cases())
    if (!c.slow) list.push_back(c);
  return list;
}

std::string test_name(const testing::TestParamInfo<Case>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, HardCase, testing::ValuesIn(quick()), test_name);

// A law whose force is along the frame's normal needs that normal to turn with the pair.
TEST(TurnedPair, turns_along_with_every_law) {
  for (const Case& c : rest_cases())
    if (c.name == "stuck pair turned by 360 degrees")
      for (const Setting& s : settings(c)) {
        const Measured m = c.run(s);
        EXPECT_TRUE(m.judged);
        EXPECT_LE(m.value, m.bound) << s.law << ", " << s.shape;
      }
}

}  // namespace
}  // namespace trackbed::hard
