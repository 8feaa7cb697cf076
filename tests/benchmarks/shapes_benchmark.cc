// Cost of one step of a bed by shape of its grains, everything included: spheres, clumps of 8,
// dilated polyhedra, and half of them polyhedra. Loose grains fall into a box and settle; then per
// touching pair of parts, per near pair, per grain and step, on one thread and on two.
//   shapes_benchmark [grains (1000)] [steps timed (1000)] [folder]
// In the folder it leaves each bed (bed_file.h) and shapes.csv, for peers.py.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>

#include "bed_file.h"
#include "dem/grain/voronoi.h"
#include "motion_scene.h"

using namespace trackbed::dem;

namespace {

constexpr double kSize = .045, kDensity = 2600;

// Processor time on one thread, so that a busy machine does not count; wall time on more.
double now(int threads) {
  timespec t;
  clock_gettime(threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
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

Scene settled(const std::vector<GrainShape>& shapes, int grains) {
  Scene s(2e7, .5);
  PairMaterial m = s.materials(0, 0);
  m.damping = damping_for_restitution("hertz_mindlin", .3);
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

// Also returns the time per touching pair and step [s].
double time_steps(Scene s, int threads, int steps) {
  s.context.threads = threads;
  double motion = 0, search = 0, pairs = 0, sums = 0, ledger = 0;
  long touched = 0, near = 0;
  for (int k = 0; k < steps; ++k) {
    double t = now(threads);
    StepWork work = drift(s.bodies, s.context);
    motion += now(threads) - t, t = now(threads);
    s.candidates.update(s.bodies, s.shapes, s.context, s.pairs);
    search += now(threads) - t, t = now(threads);
    s.evaluate_pairs(s.context.dt);
    pairs += now(threads) - t, t = now(threads);
    sum_forces(s.pairs, s.context, s.bodies);
    sums += now(threads) - t, t = now(threads);
    work += kick(s.bodies, s.context);
    motion += now(threads) - t, t = now(threads);
    s.flow.friction += friction_loss(s.pairs, threads) + viscous_loss(s.pairs, threads);
    ledger += now(threads) - t;
    touched += count_contacts(s.pairs), near += s.pairs.size();
  }
  const double whole = motion + search + pairs + sums + ledger;
  std::printf(
      "  %d thread%s %7.3f us a touching pair, %6.3f a near pair, %7.3f a grain;"
      "  motion %.0f %%, search %.0f %%, pairs %.0f %%, sums %.0f %%, ledger %.0f %%\n",
      threads, threads > 1 ? "s" : " ", 1e6 * whole / touched, 1e6 * whole / near,
      1e6 * whole / steps / s.bodies.grains, 100 * motion / whole, 100 * search / whole,
      100 * pairs / whole, 100 * sums / whole, 100 * ledger / whole);
  return whole / touched;
}

}  // namespace

int main(int argc, char** argv) {
  const int grains = argc > 1 ? std::atoi(argv[1]) : 1000,
            steps = argc > 2 ? std::atoi(argv[2]) : 1000;
  const std::string folder = argc > 3 ? argv[3] : "";
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
  const std::pair<const char*, std::vector<GrainShape>> beds[] = {
      {"spheres", {sphere_shape(.5 * kSize)}},
      {"clumps of 8", {clump_of_eight()}},
      {"dilated polyhedra", dilated},
      {"polyhedra", plain},
      {"polyhedra and clumps of 8", half}};
  for (const auto& [name, shapes] : beds) {
    const Scene s = settled(shapes, grains);
    std::printf("%s: %d grains, %d touching of %d near pairs, kinetic energy %.1e J\n", name,
                grains, count_contacts(s.pairs), s.pairs.size(), s.now().kinetic);
    if (!folder.empty())
      write_bed(s, box_of(shapes, grains), kDensity, folder + "/" + name + ".txt");
    for (const int threads : {1, 2}) {
      const double seconds = time_steps(s, threads, steps);
      csv << name << "," << grains << "," << count_contacts(s.pairs) << "," << s.context.dt << ","
          << threads << "," << seconds << "\n";
    }
  }
}
