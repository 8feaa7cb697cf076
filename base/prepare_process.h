// How the process waits and where its memory lies: OpenMP and the C library read that from the
// environment before main, so a program sets it and starts once more.
#pragma once
#include <unistd.h>

#include <cstdlib>

namespace trackbed {

/// Call first in main. Variables that are set already stay as they are.
///
/// Waiting threads: one that sleeps takes 20 to 50 us to wake, a tenth of a step; one that waits in a
/// busy loop less than one. Where a core is shared, busy loops are ruinous (a hundred times slower
/// was seen). So: busy for about a quarter of a millisecond, which bridges the passes of a step, then
/// asleep.
///
/// Memory: on the system's large pages where it has them. A step of a large bed goes through more
/// pages than the processor keeps the addresses of; and with small ones a step of 1000 spheres took
/// 115 us in one run and 160 in the next, by where their pages happened to lie.
inline void prepare_process(char** argv) {
  bool changed = false;
  const auto prefer = [&](const char* name, const char* value) {
    if (!std::getenv(name)) changed |= ::setenv(name, value, 1) == 0;
  };
  if (!std::getenv("OMP_WAIT_POLICY")) prefer("GOMP_SPINCOUNT", "10000");
  prefer("OMP_WAIT_POLICY", "passive");
  prefer("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1");
  if (changed) ::execv("/proc/self/exe", argv);  // returns only if it cannot: then as it is
}

}  // namespace trackbed
