// Cost of one exchange with an elastic body (predict + advance) against its size, and of its
// set-up. Prints a table. With the argument `surface`: against the nodes of the contact surface
// alone, full, condensed and modal.
#include <chrono>
#include <cstdio>
#include <string>

#include "fem/beam.h"
#include "fem/reduction.h"

using namespace trackbed::fem;
using Clock = std::chrono::steady_clock;

namespace {

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A subgrade under a box of 0.6 m, or a sleeper of 2.6 m.
ElasticBodyParameters subgrade(int nx, int ny, int nz, int order) {
  ElasticBodyParameters p;
  p.name = "subgrade";
  p.mesh.lengths = {0.6, 0.3, 0.6};
  p.mesh.elements = {nx, ny, nz};
  p.materials = {{"soil", 60e6, 0.3, 1900}};
  p.order = order;
  p.supports = {{"bottom", Support::fixed},
                {"x_min", Support::roller},
                {"x_max", Support::roller},
                {"y_min", Support::roller},
                {"y_max", Support::roller}};
  p.contact = {"top"};
  return p;
}

ElasticBodyParameters sleeper(int nx, int ny, int nz, int order) {
  ElasticBodyParameters p;
  p.name = "sleeper";
  p.mesh.lengths = {2.6, 0.28, 0.2};
  p.mesh.elements = {nx, ny, nz};
  p.materials = {{"concrete", 40e9, 0.2, 2500}};
  p.order = order;
  p.contact = {"bottom", "x_min", "x_max", "y_min", "y_max"};
  return p;
}

std::unique_ptr<Structure> build(const ElasticBodyParameters& p, Reduction reduction) {
  if (reduction == Reduction::none) return std::make_unique<ElasticBody>(p);
  return reduced_body(p, reduction, 20);
}

void run(const char* name, const ElasticBodyParameters& p, Reduction reduction = Reduction::none) {
  auto start = Clock::now();
  const auto built = build(p, reduction);
  Structure& body = *built;
  const double build = seconds_since(start);
  start = Clock::now();
  body.set_step(1e-5);
  const double factorise = seconds_since(start);
  std::vector<Vec> u, v, f(body.surface().nodes.size(), Vec{0, 0, -1});
  body.predict(u, v);
  body.advance(f);
  int steps = 0;
  start = Clock::now();
  while (seconds_since(start) < 1) {
    body.predict(u, v);
    body.advance(f);
    ++steps;
  }
  std::printf("%-22s %8d %8zu %9.3f %9.3f %9.3f\n", name, body.unknowns(), f.size(), build,
              factorise, 1e3 * seconds_since(start) / steps);
}

// The cells below the surface stay as they are; 20 normal modes.
void against_surface_nodes() {
  for (const int n : {2, 4, 6, 8}) {
    const ElasticBodyParameters p = subgrade(2 * n, n, 4, 1);
    run("full", p);
    run("  condensed", p, Reduction::condensed);
    run("  modal", p, Reduction::modal);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-22s %8s %8s %9s %9s %9s\n", "body", "unknowns", "surface", "build s", "factor s",
              "step ms");
  if (argc > 1 && std::string(argv[1]) == "surface") {
    against_surface_nodes();
    return 0;
  }
  run("sleeper 26x3x2 Q1", sleeper(26, 3, 2, 1));
  run("sleeper 26x3x2 Q2", sleeper(26, 3, 2, 2));
  run("  modal", sleeper(26, 3, 2, 2), Reduction::modal);
  run("  condensed", sleeper(26, 2, 2, 1), Reduction::condensed);
  for (const bool lumped : {true, false}) {
    const auto under = [&](int nx, int ny, int nz, int order) {
      auto p = subgrade(nx, ny, nz, order);
      p.mass = lumped ? Mass::lumped : Mass::consistent;
      return p;
    };
    std::printf("%s\n", lumped ? "lumped mass, explicit:" : "consistent mass, implicit:");
    run("subgrade 12x6x8 Q1", under(12, 6, 8, 1));
    if (lumped) run("  condensed", under(12, 6, 8, 1), Reduction::condensed);
    run("subgrade 16x8x12 Q1", under(16, 8, 12, 1));
    run("subgrade 28x14x16 Q1", under(28, 14, 16, 1));
    run("subgrade 14x7x8 Q2", under(14, 7, 8, 2));
  }
}
