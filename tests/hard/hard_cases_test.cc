// Every hard case at its first setting; the command hard_cases runs all settings.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>

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

// What the stability page says other tests hold, they hold: the names are there.
TEST(Elsewhere, names_tests_that_there_are) {
  namespace fs = std::filesystem;
  std::string sources;
  for (const auto& file : fs::recursive_directory_iterator(TESTS)) {
    const fs::path ending = file.path().extension();
    if (ending != ".cc" && ending != ".py") continue;
    std::ifstream in(file.path());
    sources += std::string(std::istreambuf_iterator<char>(in), {});
  }
  std::ifstream list(std::string(TESTS) + "/hard/elsewhere.txt");
  int rows = 0;
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line[0] == '#') continue;
    ++rows;
    const auto last = line.rfind('|');
    ASSERT_NE(last, std::string::npos) << line;
    std::stringstream words(line.substr(last + 1));
    int count = 0;
    for (std::string name; words >> name; ++count) {
      const auto dot = name.find('.');
      const bool there = dot == std::string::npos
                             ? fs::exists(std::string(TESTS) + "/failures/" + name + "/case.txt") ||
                                   sources.find("def test_" + name + "(") != std::string::npos
                             : sources.find("(" + name.substr(0, dot) + ", " +
                                            name.substr(dot + 1) + ")") != std::string::npos;
      EXPECT_TRUE(there) << line.substr(0, line.find('|')) << ": no test " << name;
    }
    EXPECT_GT(count, 0) << line;
  }
  EXPECT_GT(rows, 10);
}

}  // namespace
}  // namespace trackbed::hard
