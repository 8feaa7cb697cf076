// named_curve of curve.h: the gradings of papers and standards. One row per curve; sieves in mm,
// limits in percent passing by mass.
//
// Checked against its text: Shao, Lian, Yang 2017, Table 4.
// UNCHECKED against their texts, which were not at hand (quoted from memory): TB/T 2140-2008 tables
// for special and first grade, EN 13450:2013 Table 1, AREMA Manual chapter 1 part 2, table 1-2-2.
// Some limits agree with another source; `compared` says which and where. No second source was
// found for EN 13450 and AREMA No. 3 and 24. Compare with the standard before a result depends on a
// limit.
#include <algorithm>

#include "base/error.h"
#include "dem/grading/curve.h"
#include "dem/grain/nearest_name.h"

namespace trackbed::dem {
namespace {

struct Row {
  const char* name;
  const char* source;
  bool checked;
  const char* compared;                    // which limits agree with a second source; "" = none
  std::vector<double> sieve, least, most;  // least == most everywhere: a curve without band
};

const char* const shao = "Shao, Lian, Yang 2017, Table 4";
const char* const tbt = "TB/T 2140-2008";
const char* const en = "EN 13450:2013, Table 1";
const char* const special = "all limits, with those quoted at kxting.com (article 6809731)";
const char* const first =
    "all limits, with those quoted at kxting.com (article 6809731), which has 100 % at 63 mm where "
    "this band has 97 to 100 %";
const char* const number_4 =
    "all limits, with the 1988 ones quoted by Graniterock (technical report AREMA #4 ballast)";
const char* const number_4a =
    "38.1 mm and above, with a railway's section 20110, ballast and walkway aggregate";
const char* const arema = "AREMA Manual for Railway Engineering, chapter 1 part 2, table 1-2-2";

const std::vector<double> shao_mm = {16, 25, 35.5, 45, 56, 63};
const std::vector<double> square_mm = {22.4, 31.5, 40, 50, 63};
const std::vector<double> square80_mm = {22.4, 31.5, 40, 50, 63, 80};

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {"shao2017_large", shao, true, "", shao_mm, {0, 0, 0, 0, 0, 100}, {0, 0, 0, 0, 0, 100}},
      {"shao2017_small",
       shao,
       true,
       "",
       shao_mm,
       {0, 0, 100, 100, 100, 100},
       {0, 0, 100, 100, 100, 100}},
      {"shao2017_wide", shao, true, "", shao_mm, {0, 0, 4, 33, 79, 95}, {0, 0, 4, 33, 79, 95}},
      {"tbt2140_special",
       tbt,
       false,
       special,
       square_mm,
       {0, 1, 30, 70, 100},
       {3, 25, 65, 99, 100}},
      {"tbt2140_first",
       tbt,
       false,
       first,
       shao_mm,
       {0, 5, 25, 55, 92, 97},
       {5, 15, 40, 75, 97, 100}},
      {"tbt2140_first_existing",
       tbt,
       false,
       first,
       {25, 35.5, 45, 56, 63},
       {0, 25, 55, 92, 97},
       {5, 40, 75, 97, 100}},
      {"en13450_a", en, false, "", square_mm, {0, 1, 30, 70, 100}, {3, 25, 65, 99, 100}},
      {"en13450_b", en, false, "", square80_mm, {0, 1, 30, 70, 97, 100}, {3, 25, 70, 99, 100, 100}},
      {"en13450_c", en, false, "", square80_mm, {0, 1, 25, 70, 95, 100}, {3, 25, 75, 99, 100, 100}},
      {"en13450_d", en, false, "", square80_mm, {0, 1, 30, 65, 97, 100}, {3, 25, 65, 99, 99, 100}},
      {"en13450_e", en, false, "", square80_mm, {0, 1, 25, 55, 95, 100}, {3, 25, 75, 99, 99, 100}},
      {"en13450_f", en, false, "", square80_mm, {0, 0, 15, 45, 93, 100}, {7, 7, 40, 70, 99, 100}},
      {"arema_24",
       arema,
       false,
       "",
       {12.7, 19.05, 38.1, 63.5, 76.2},
       {0, 0, 25, 90, 100},
       {5, 10, 60, 100, 100}},
      {"arema_3",
       arema,
       false,
       "",
       {12.7, 25.4, 38.1, 50.8, 63.5},
       {0, 0, 35, 95, 100},
       {5, 15, 70, 100, 100}},
      {"arema_4a",
       arema,
       false,
       number_4a,
       {9.525, 19.05, 25.4, 38.1, 50.8, 63.5},
       {0, 0, 10, 60, 90, 100},
       {3, 10, 35, 90, 100, 100}},
      {"arema_4",
       arema,
       false,
       number_4,
       {9.525, 19.05, 25.4, 38.1, 50.8},
       {0, 0, 20, 90, 100},
       {5, 15, 55, 100, 100}},
  };
  return all;
}

}  // namespace

std::vector<std::string> curve_names() {
  std::vector<std::string> names;
  for (const Row& row : rows()) names.push_back(row.name);
  return names;
}

SieveCurve named_curve(const std::string& name) {
  const auto row =
      std::find_if(rows().begin(), rows().end(), [&](const Row& r) { return name == r.name; });
  if (row == rows().end()) throw InputError(unknown_name("grading", name, curve_names()));
  SieveCurve c;
  c.name = row->name;
  c.source = row->source;
  c.checked = row->checked;
  c.compared = row->compared;
  for (size_t i = 0; i < row->sieve.size(); ++i) {
    c.sieve.push_back(row->sieve[i] / 1000);
    c.passing.push_back(0.5 * (row->least[i] + row->most[i]));
  }
  if (row->least != row->most) c.band_min = row->least, c.band_max = row->most;
  validate(c);
  return c;
}

}  // namespace trackbed::dem
