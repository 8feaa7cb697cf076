// What accuracy costs, where it can be known exactly: ladders of single numerical choices, each
// against a closed form or a published value.
// usage: accuracy_study FOLDER; writes FOLDER/accuracy.csv and prints the table of the README
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "ladder.h"

namespace trackbed::study {

double fitted_order(const Ladder& l) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Rung& r : l.rungs) {
    if (!(r.size > 0 && r.error > 0)) continue;
    const double a = std::log(r.size), b = std::log(r.error);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return n < 2 ? NAN : (n * xy - x * y) / (n * xx - x * x);
}

namespace {

void print(const Ladder& l) {
  const double order = fitted_order(l);
  for (const Rung& r : l.rungs) {
    const bool first = &r == &l.rungs.front();
    std::printf("| %s | %s | %.2g | ", first ? (l.name + ": " + l.knob).c_str() : "",
                r.name.c_str(), r.error);
    if (r.seconds > 0) std::printf("%.2g", 1e3 * r.seconds);
    std::printf(" | ");
    if (r.count > 0) std::printf("%.4g%s", r.count, first ? (" " + l.counted).c_str() : "");
    std::printf(" | ");
    if (first && !std::isnan(order)) std::printf("%.2f", order);
    if (first && !l.theory.empty()) std::printf(", theory %s", l.theory.c_str());
    std::printf(" |\n");
  }
  std::fflush(stdout);
}

void write(const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream csv(folder + "/accuracy.csv");
  csv << "ladder,knob,rung,size,error,error_of,seconds,seconds_of,count,counted,fitted_order,"
         "theory\n";
  csv.precision(5);
  std::printf(
      "| ladder: knob | rung | error | time ms | count | order |\n|---|---|---|---|---|---|\n");
  const auto add = [&](const std::vector<Ladder>& ladders) {
    for (const Ladder& l : ladders) {
      print(l);
      for (const Rung& r : l.rungs)
        csv << '"' << l.name << "\",\"" << l.knob << "\",\"" << r.name << "\"," << r.size << ','
            << r.error << ",\"" << l.error << "\"," << r.seconds << ",\"" << l.cost << "\","
            << r.count << ",\"" << l.counted << "\"," << fitted_order(l) << ",\"" << l.theory
            << "\"\n";
    }
  };
  add(motion_ladders());
  add(grain_ladders());
  add(element_ladders());
  add(body_ladders());
  add(exchange_ladders());
}

}  // namespace
}  // namespace trackbed::study

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: accuracy_study FOLDER\n");
    return 2;
  }
  try {
    trackbed::study::write(argv[1]);
  } catch (const trackbed::InputError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
