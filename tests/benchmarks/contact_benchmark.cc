// Time of one pair on one core: overlap and law for touching pairs, one projection for pairs that
// their cached axis keeps apart. Grains: Voronoi cells of about 14-20 corners; random directions;
// overlaps of 0.1-1 % of the size; one warm-up evaluation gives each pair its cached axis.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "dem/grain/voronoi.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

struct Pairs {
  ShapeTable table;
  std::vector<int> a, b;
  std::vector<Pose> pa, pb;
  std::vector<Vec3> axis;
};

const Pairs& pairs(bool touching) {
  static const auto make = [](bool touch) {
    Pairs p;
    Random random(5);
    VoronoiParameters parameters;
    parameters.count = 1000;
    const std::vector<Polyhedron> grains = voronoi_grains(parameters);
    for (const Polyhedron& g : grains)
      if (g.vertices.size() >= 14 && g.vertices.size() <= 20)
        p.table.add(make_grain_shape(scaled(g, 0.05)));
    for (int k = 0; k < 4 * p.table.size(); ++k) {
      const int i = k / 4, j = int(random.below(p.table.size()));  // sorted by a, as in a run
      const Pose pa{random_rotation(random), 0.5 * random.direction()};
      const double share = touch ? std::pow(10, random.uniform(-3, -2)) : -0.01;
      const Pose pb = touching_pose(random, p.table.view(i), pa, p.table.view(j), share);
      Vec3 axis = Vec3::Zero();
      separating_axis(p.table.view(i), pa, p.table.view(j), pb, axis);
      if (touch) axis = evaluate(p.table.view(i), pa, p.table.view(j), pb, axis).area.normalized();
      p.a.push_back(i), p.b.push_back(j), p.pa.push_back(pa), p.pb.push_back(pb);
      p.axis.push_back(axis);
    }
    return p;
  };
  static const Pairs touch = make(true), near = make(false);
  return touching ? touch : near;
}

void per_pair(benchmark::State& state, int count) {
  state.counters["us/pair"] =
      benchmark::Counter(1e-6 * double(count) * double(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// From poses and cached axis to force and moment.
void TouchingPair(benchmark::State& state) {
  const Pairs& p = pairs(true);
  const PairMaterial m = material(1e10);
  const StoredEnergyLaw law;
  OverlapWorkspace work;
  for (auto _ : state)
    for (std::size_t k = 0; k < p.a.size(); ++k) {
      const ConvexView &a = p.table.view(p.a[k]), &b = p.table.view(p.b[k]);
      work.clear();
      OverlapMoments moments;
      const ContactFrame frame = contact_frame(a, p.pa[k], b, p.pb[k], p.axis[k]);
      if (!overlap(a, p.pa[k], b, p.pb[k], frame, work, moments)) continue;
      const OverlapShape shape = make_shape(moments, work);
      const NormalResponse response = law(shape, m);
      PressureForce f = integrate_pressure(work, work.a_pieces, shape, response);
      benchmark::DoNotOptimize(f);
    }
  per_pair(state, int(p.a.size()));
}
BENCHMARK(TouchingPair)->Unit(benchmark::kMicrosecond);

void NearPair(benchmark::State& state) {
  const Pairs& p = pairs(false);
  for (auto _ : state)
    for (std::size_t k = 0; k < p.a.size(); ++k) {
      Vec3 axis = p.axis[k];
      double gap =
          separating_axis(p.table.view(p.a[k]), p.pa[k], p.table.view(p.b[k]), p.pb[k], axis);
      benchmark::DoNotOptimize(gap);
    }
  per_pair(state, int(p.a.size()));
}
BENCHMARK(NearPair)->Unit(benchmark::kMicrosecond);

// Parts of a touching pair.
void FrameOnly(benchmark::State& state) {
  const Pairs& p = pairs(true);
  for (auto _ : state)
    for (std::size_t k = 0; k < p.a.size(); ++k) {
      ContactFrame frame =
          contact_frame(p.table.view(p.a[k]), p.pa[k], p.table.view(p.b[k]), p.pb[k], p.axis[k]);
      benchmark::DoNotOptimize(frame);
    }
  per_pair(state, int(p.a.size()));
}
BENCHMARK(FrameOnly)->Unit(benchmark::kMicrosecond);

void FrameAndOverlap(benchmark::State& state) {
  const Pairs& p = pairs(true);
  OverlapWorkspace work;
  for (auto _ : state)
    for (std::size_t k = 0; k < p.a.size(); ++k) {
      const ConvexView &a = p.table.view(p.a[k]), &b = p.table.view(p.b[k]);
      work.clear();
      OverlapMoments moments;
      const ContactFrame frame = contact_frame(a, p.pa[k], b, p.pb[k], p.axis[k]);
      bool touching = overlap(a, p.pa[k], b, p.pb[k], frame, work, moments);
      benchmark::DoNotOptimize(touching);
    }
  per_pair(state, int(p.a.size()));
}
BENCHMARK(FrameAndOverlap)->Unit(benchmark::kMicrosecond);

// A pair whose cached axis fails though the bodies are apart: the search for a new axis.
void NewAxis(benchmark::State& state) {
  const Pairs& p = pairs(false);
  for (auto _ : state)
    for (std::size_t k = 0; k < p.a.size(); ++k) {
      Vec3 axis = Vec3::Zero();
      double gap =
          separating_axis(p.table.view(p.a[k]), p.pa[k], p.table.view(p.b[k]), p.pb[k], axis);
      benchmark::DoNotOptimize(gap);
    }
  per_pair(state, int(p.a.size()));
}
BENCHMARK(NewAxis)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace trackbed::dem::test

BENCHMARK_MAIN();
