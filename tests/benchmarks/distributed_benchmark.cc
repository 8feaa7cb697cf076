// A structure's implicit step shared by ranks: one line of the scaling table.
//   for n in 1 2 4; do mpirun --oversubscribe -n $n build/tests/distributed_benchmark 20 cg_gamg;
//   done
// prints ranks, unknowns, unknowns of each rank (of a material with history the cells that each
// evaluates, too), iterations of a solve, milliseconds a step and for
// the set-up. A cube of 20^3 cells if nothing is said. A third word names a material with history,
// a fourth its step [s]: 1e-3 by Newton's iteration, 1e-5 without a solve.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "fem/distributed_body.h"
#include "fem/session.h"
#include "fem/subgrades/registry.h"

using namespace trackbed::fem;

int main(int argc, char** argv) {
  start_session();
  const int n = argc > 1 ? std::atoi(argv[1]) : 20;
  ElasticBodyParameters p;
  p.mesh.lengths = {1, 1, 1};
  p.mesh.elements = {n, n, n};
  Material m;
  m.name = "soil", m.young = 6e7, m.poisson = .3, m.density = 1900;
  p.materials = {m};
  p.supports["bottom"] = Support::fixed;
  p.contact = {"top"};
  p.mass = Mass::consistent;
  p.solver = solver_of(argc > 2 ? argv[2] : "cg_gamg");
  const auto build = [&](int, double) {
    std::vector<std::unique_ptr<Structure>> bodies;
    bodies.push_back(
        std::make_unique<DistributedBody>(p, argc > 3 ? stress_model(argv[3], {}) : nullptr));
    return bodies;
  };
  if (rank() > 0) {
    serve(build);
    return 0;
  }
  using Clock = std::chrono::steady_clock;
  const auto milliseconds = [](Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
  };
  {
    auto start = Clock::now();
    ask_to_build(0, 0);
    auto bodies = build(0, 0);
    auto& body = static_cast<DistributedBody&>(*bodies[0]);
    body.set_step(argc > 4 ? std::atof(argv[4]) : 1e-3);
    const double set_up = milliseconds(start);
    std::vector<Vec> force(body.surface().nodes.size(), Vec{0, 0, -10}), u, v;
    body.advance(force);
    start = Clock::now();
    const int steps = 10;
    int iterations = 0;
    for (int k = 0; k < steps; ++k) {
      body.predict(u, v);
      for (Vec& f : force) f[2] -= 1;
      body.advance(force);
      iterations += body.solver_iterations();
    }
    const double step = milliseconds(start) / steps;
    std::printf("ranks %d, unknowns %d (", ranks(), body.unknowns());
    for (const int own : body.rank_unknowns()) std::printf(" %d", own);
    for (const int cells : body.rank_cells()) std::printf(" / %d cells", cells);
    std::printf(" ), iterations %.1f, step %.1f ms, set-up %.0f ms\n",
                static_cast<double>(iterations) / steps, step, set_up);
  }
  release_ranks();
}
