// What the fuzzers' command lines ask for:
//   SECONDS|--pairs COUNT [--seed N] [--output DIR] [--keep PAIR]
#pragma once
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

namespace trackbed::dem::test {

struct FuzzOrder {
  double seconds = 0;
  long pairs = 0;
  std::uint64_t seed = 1;
  std::string folder = "results/fuzz";  ///< for offenders
  long keep = -1;                       ///< a pair to keep whether it offends or not
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();

  double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }
  /// Twenty offenders are enough to look at.
  bool is_done(long judged, int offenders) const {
    return judged >= pairs || elapsed() >= seconds || offenders >= 20;
  }
  /// Of the files that keep an offender.
  std::string stem(long pair) const {
    return folder + "/seed_" + std::to_string(seed) + "_pair_" + std::to_string(pair);
  }
};

/// The exit code of a fuzzer: fuzz(order) if the arguments say how long, else 2.
template <class Fuzz>
int fuzz_as_ordered(int argc, char** argv, const char* name, Fuzz&& fuzz) {
  FuzzOrder order;
  for (int k = 1; k < argc; ++k) {
    if (!std::strcmp(argv[k], "--seed") && k + 1 < argc)
      order.seed = std::strtoull(argv[++k], nullptr, 10);
    else if (!std::strcmp(argv[k], "--output") && k + 1 < argc)
      order.folder = argv[++k];
    else if (!std::strcmp(argv[k], "--keep") && k + 1 < argc)
      order.keep = std::strtol(argv[++k], nullptr, 10);
    else if (!std::strcmp(argv[k], "--pairs") && k + 1 < argc)
      order.pairs = std::strtol(argv[++k], nullptr, 10);
    else
      order.seconds = std::strtod(argv[k], nullptr);
  }
  if (!(order.seconds > 0) && !(order.pairs > 0)) {
    std::fprintf(stderr,
                 "%s SECONDS|--pairs COUNT [--seed N] [--output DIR] [--keep PAIR]: how long?\n",
                 name);
    return 2;
  }
  if (!(order.seconds > 0)) order.seconds = HUGE_VAL;
  if (!(order.pairs > 0)) order.pairs = std::numeric_limits<long>::max();
  return fuzz(order);
}

}  // namespace trackbed::dem::test
