// Cost of one step of a bed by shape of its grains, everything included: spheres, clumps of 8,
// dilated polyhedra without and with flat faces that answer by their area, and half of them
// polyhedra. Loose grains fall into a box and settle; then per
// touching pair of parts, per grain and step, on one thread and on two, and per near pair that does
// not touch, such pairs by themselves.
//   shapes_benchmark [grains (1000)] [steps timed (1000)] [folder or ""] [only this shape or ""]
//                    [threads (2)]
// In the folder it leaves each bed (bed_file.h) and shapes.csv, for peers.py.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <random>

#include "base/prepare_process.h"
#include "bed_file.h"
#include "dem/grain/voronoi.h"
#include "in_turn.h"
#include "motion_scene.h"

using namespace trackbed::dem;

namespace {

constexpr double kSize = .045, kDensity = 2600;

// Processor time on one thread, so that a busy machine does not count; wall time on more.
double now(int threads) {
  return seconds_of(threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC);
}

GrainShape clump_of_eight() {
  std::vector<Sphere> spheres;
  for (int k = 0; k < 8; ++k)
    spheres.push_back({.22 * kSize * Vec3(k & 1 ? 1 : -1, k & 2 ? .8 : -.8, k & 4 ? .7 : -.7),
                       (.24 + .01 * k) * kSize});
  return as_grain(make_clump_shape(spheres));
}

std::vector<GrainShape> polyhedra() {
  VoronoiParameters p;
  p.count = 40;
  std::vector<GrainShape> shapes;
  for (const Polyhedron& body : voronoi_grains(p)) {
    const GrainShape s = make_grain_shape(body);
    shapes.push_back(scaled(s, .5 * kSize / s.radius));
  }
  return shapes;
}

GrainShape rounded(const GrainShape& s) {
  DilatedPolyhedron body{s.body, .08 * kSize};
  for (Vec3& v : body.core.vertices) v *= 1 - .08 * kSize / s.radius;
  return as_grain(make_dilated_shape(body));
}

// The container of so many grains, which start in it `row` by `row` in layers and do not touch.
int row_of(int grains) { return std::max(3, static_cast<int>(std::cbrt(grains))); }
double cell_of(const std::vector<GrainShape>& shapes) {
  double radius = 0;
  for (const GrainShape& s : shapes) radius = std::max(radius, s.radius);
  return 2.04 * radius;
}
Vec3 box_of(const std::vector<GrainShape>& shapes, int grains) {
  return cell_of(shapes) * row_of(grains) * Vec3(1, 1, 2);
}

Scene settled(const std::vector<GrainShape>& shapes, int grains, const std::string& law) {
  Scene s(2e7, .5);
  s.round = make_round_forces(law, true);
  PairMaterial m = s.materials(0, 0);
  m.damping = damping_for_restitution(law, .3);
  s.materials.set(0, 0, m);
  std::mt19937 random(11);
  const auto u = [&] { return random() / 2147483648. - 1; };
  const int row = row_of(grains);
  const double cell = cell_of(shapes);
  for (int i = 0; i < grains; ++i) {
    const Vec3 at(i % row + .5 + .01 * u(), i / row % row + .5 + .01 * u(), i / (row * row) + .5);
    s.add(shapes[i % shapes.size()], kDensity, cell * at, turn_about({u(), u(), u()}, 3 * u()));
  }
  add_container(s.bodies, s.shapes, {0, 0, 0}, box_of(shapes, grains), .1, 0);
  s.context.local_damping = .3;
  s.prepare();
  s.context.dt = .3 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  s.run(.4);
  s.context.local_damping = .7;
  double weight = 0;
  for (int i = 0; i < s.bodies.grains; ++i) weight += 9.81 * s.bodies.mass[i];
  for (int k = 0; k < 40 && (k < 5 || s.now().kinetic > 1e-6 * weight * kSize); ++k)
    s.run(s.time + .1);
  return s;
}

// Time of the whole step [s]; the clock is read at both ends only.
double time_whole(Scene s, int threads, int steps) {
  s.context.threads = threads;
  const double start = now(threads);
  for (int k = 0; k < steps; ++k) s.step();
  return (now(threads) - start) / steps;
}

// Stages of a step, as shares of it.
void print_stages(Scene s, int threads, int steps) {
  s.context.threads = threads;
  double motion = 0, search = 0, pairs = 0, sums = 0, ledger = 0;
  for (int k = 0; k < steps; ++k) {
    double t = now(threads);
    const auto lap = [&] {
      const double before = t;
      t = now(threads);
      return t - before;
    };
    StepWork work = drift(s.bodies, s.context);
    motion += lap();
    s.candidates.update(s.bodies, s.shapes, s.context, s.pairs);
    search += lap();
    s.evaluate_pairs(s.context.dt);
    pairs += lap();
    sum_forces(s.pairs, s.context, s.bodies);
    sums += lap();
    work += kick(s.bodies, s.context);
    motion += lap();
    s.flow.friction += friction_loss(s.pairs, threads) + viscous_loss(s.pairs, threads);
    ledger += lap();
  }
  const double whole = (motion + search + pairs + sums + ledger) / 100;
  std::printf("  motion %.0f %%, search %.0f %%, pairs %.0f %%, sums %.0f %%, ledger %.0f %%\n",
              motion / whole, search / whole, pairs / whole, sums / whole, ledger / whole);
}

// Time per near pair that does not touch and step [s]: such pairs again, by themselves, in a bed
// that goes on as ever.
double time_near(Scene s, int steps) {
  Pairs near;
  long rebuilds = -1, count = 0;
  double seconds = 0, clock = now(1);
  for (int k = 0; k < 1000; ++k) now(1);
  clock = (now(1) - clock) / 1001;
  for (int k = 0; k < steps; ++k) {
    s.step();
    if (s.candidates.state().rebuilds != rebuilds) {
      rebuilds = s.candidates.state().rebuilds;
      near = s.pairs;
      std::vector<int> kept;
      for (int p = 0; p < near.size(); ++p)
        if (!near.touching[p]) kept.push_back(p);
      near.rearrange(kept);
      near.index_bodies(s.bodies.size());
    }
    const double start = now(1);
    s.forces.evaluate(s.bodies, s.shapes, s.materials, s.context, s.candidates.travel(), near);
    s.round.evaluate(s.bodies, s.shapes, s.materials, s.context, s.candidates.travel(), near);
    seconds += now(1) - start - clock;
    count += near.size() - count_contacts(near);
  }
  return seconds / count;
}

}  // namespace

int main(int argc, char** argv) {
  trackbed::prepare_process(argv);
  const int grains = argc > 1 ? std::atoi(argv[1]) : 1000,
            steps = argc > 2 ? std::atoi(argv[2]) : 1000;
  const std::string folder = argc > 3 ? argv[3] : "", only = argc > 4 ? argv[4] : "";
  const int most_threads = argc > 5 ? std::atoi(argv[5]) : 2;
  std::ofstream csv;
  if (!folder.empty()) {
    csv.open(folder + "/shapes.csv");
    csv << "shape,grains,touching_pairs,time_step_s,threads,seconds_per_touching_pair\n";
  }
  const std::vector<GrainShape> plain = polyhedra();
  std::vector<GrainShape> dilated, half;
  for (const GrainShape& s : plain) {
    dilated.push_back(rounded(s));
    half.push_back(s), half.push_back(clump_of_eight());
  }
  struct Bed {
    const char* name;
    std::vector<GrainShape> shapes;
    const char* law;
  };
  const Bed beds[] = {{"spheres", {sphere_shape(.5 * kSize)}, "hertz_mindlin"},
                      {"clumps of 8", {clump_of_eight()}, "hertz_mindlin"},
                      {"dilated polyhedra", dilated, "hertz_mindlin"},
                      {"dilated polyhedra, flat faces", dilated, "hertz_flat"},
                      {"polyhedra", plain, "hertz_mindlin"},
                      {"polyhedra and clumps of 8", half, "hertz_mindlin"}};
  for (const auto& [name, shapes, law] : beds) {
    if (!only.empty() && only != name) continue;
    const Scene s = settled(shapes, grains, law);
    std::printf("%s: %d grains, %d touching of %d near pairs, kinetic energy %.1e J\n", name,
                grains, count_contacts(s.pairs), s.pairs.size(), s.now().kinetic);
    if (!folder.empty())
      write_bed(s, box_of(shapes, grains), kDensity, folder + "/" + name + ".txt");
    for (int threads = 1; threads <= most_threads; ++threads) {
      const double step = time_whole(s, threads, steps), seconds = step / count_contacts(s.pairs);
      std::printf("  %d thread%s: %.3f us a touching pair, %.3f us a grain;", threads,
                  threads > 1 ? "s" : "", 1e6 * seconds, 1e6 * step / grains);
      print_stages(s, threads, steps / 4 + 1);
      csv << std::quoted(std::string(name)) << "," << grains << "," << count_contacts(s.pairs)
          << "," << s.context.dt << "," << threads << "," << seconds << "\n";
    }
    if (most_threads > 1) print_gain(gain_of_threads(s, most_threads), most_threads);
    std::printf("  %.3f us a near pair that does not touch\n", 1e6 * time_near(s, steps / 4 + 1));
    std::fflush(stdout);
  }
}
