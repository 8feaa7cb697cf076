// Cost of one step of a settled bed of Voronoi grains, everything included, per touching pair and
// step, per grain and step; the share of each stage; one thread and two.
//   motion_benchmark [grains (1000)] [steps timed (300)] [folder the bed is kept in]
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "base/prepare_process.h"
#include "in_turn.h"
#include "settled_bed.h"

using namespace trackbed::dem;

namespace {

// Processor time on one thread, so that a busy machine does not count; wall time on more.
double now(int threads) {
  return seconds_of(threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC);
}

void time_steps(Scene s, int threads, int steps) {
  s.context.threads = threads;
  double motion = 0, search = 0, pairs = 0, sums = 0, ledger = 0;
  long touched = 0, near = 0, woken = 0;
  const long rebuilds = s.candidates.state().rebuilds;
  for (int k = 0; k < steps; ++k) {
    double t = now(threads);
    StepWork work = drift(s.bodies, s.context);
    motion += now(threads) - t, t = now(threads);
    s.candidates.update(s.bodies, s.shapes, s.context, s.pairs);
    search += now(threads) - t, t = now(threads);
    const std::vector<double>& travel = s.candidates.travel();
    for (int p = 0; p < s.pairs.size(); ++p)
      woken += travel[s.pairs.a[p]] + travel[s.pairs.b[p]] >= s.pairs.wake[p];
    t = now(threads);
    s.forces.evaluate(s.bodies, s.shapes, s.materials, s.context, s.candidates.travel(), s.pairs);
    pairs += now(threads) - t, t = now(threads);
    sum_forces(s.pairs, s.context, s.bodies);
    sums += now(threads) - t, t = now(threads);
    work += kick(s.bodies, s.context);
    motion += now(threads) - t, t = now(threads);
    s.flow.friction += friction_loss(s.pairs, threads);
    ledger += now(threads) - t;
    touched += count_contacts(s.pairs), near += s.pairs.size();
  }
  const double whole = motion + search + pairs + sums + ledger;
  std::printf("%d thread%s: %7.3f us per touching pair and step, %.3f per grain (%.0f us a step)\n",
              threads, threads > 1 ? "s" : " ", 1e6 * whole / touched,
              1e6 * whole / steps / s.bodies.grains, 1e6 * whole / steps);
  std::printf("  touching %.0f, looked at %.0f, candidates %.0f of %d grains; %ld searches\n",
              double(touched) / steps, double(woken) / steps, double(near) / steps, s.bodies.grains,
              s.candidates.state().rebuilds - rebuilds);
  std::printf("  motion %.1f %%  candidates %.1f %%  pairs %.1f %%  sums %.1f %%  ledger %.1f %%\n",
              100 * motion / whole, 100 * search / whole, 100 * pairs / whole, 100 * sums / whole,
              100 * ledger / whole);
}

}  // namespace

int main(int argc, char** argv) {
  trackbed::prepare_process(argv);
  BedSettings bed;
  bed.grains = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int steps = argc > 2 ? std::atoi(argv[2]) : 300;
  bed.folder = argc > 3 ? argv[3] : "";
  const double start = now(2);
  const Scene s = settled_bed(bed);
  const TimeStepLimit expected = expected_limit(s.bodies, s.shapes, s.materials, {}),
                      measured = measured_limit(s.bodies, s.pairs, 1);
  std::printf("settled %d grains in %.1f s, kinetic energy %.2e J, coordination %.2f\n", bed.grains,
              now(2) - start, s.now().kinetic, 2. * count_contacts(s.pairs) / bed.grains);
  std::printf("limits of the step: expected %.3e s, measured %.3e s (grain %d, %d contacts)\n",
              expected.dt, measured.dt, measured.body, measured.contacts);
  for (const int threads : {1, 2}) time_steps(s, threads, steps);
  print_gain(gain_of_threads(s, 2), 2);
}
