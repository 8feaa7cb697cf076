#include <cmath>
#include <numeric>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/materials.h"
#include "base/error.h"
#include "coupling/edit.h"
#include "dem/grading/sieve_size.h"
#include "dem/packing/duplicate.h"
#include "dem/packing/packing_file.h"

namespace trackbed::apps {
namespace {

// Edge of the cube of the mean volume [m].
double mean_size(const dem::PackedGrains& grains) {
  double volume = 0;
  for (const dem::GrainShape& s : grains.shape) volume += s.volume;
  return std::cbrt(volume / grains.size());
}

}  // namespace

void place_imported(Run& run) {
  const std::string& file = run.scene.packing.start_from;
  dem::PackedGrains grains = dem::read_packing(file);
  const Layout& l = run.layout;
  const std::vector<double>& origin = run.scene.packing.origin;
  for (int i = 0; i < grains.size(); ++i) {
    dem::Vec3& x = grains.centre[i];
    x -= dem::Vec3(origin[0], origin[1], origin[2]);
    bool inside = x.z() > l.low.z();
    for (int k = 0; k < 2; ++k) inside = inside && x[k] >= l.low[k] && x[k] <= l.high[k];
    if (!inside)
      throw InputError(file + ": the centre of grain " + std::to_string(i) + " at (" +
                       shortest(x.x()) + ", " + shortest(x.y()) + ", " + shortest(x.z()) +
                       ") m lies outside the scene's container (Packing/Start from, Origin)");
    if (grains.shape[i].sieve_size <= 0)
      grains.shape[i].sieve_size = dem::sieve_size(
          grains.shape[i].body, dem::parse_sieve_method(run.scene.grains.sieve_method));
  }
  coupling::add_grains(run.world, grains.shape, grains.centre, grains.turn,
                       run.scene.grains.density, kGrain);
}

void duplicate_sample(Run& run) {
  coupling::World& w = run.world;
  const PackingScene& p = run.scene.packing;
  dem::PackedGrains bed = dem::packed_grains(w.bodies, w.shapes);
  // All bodies anew: the walls are longer now.
  std::vector<int> all(w.bodies.size());
  std::iota(all.begin(), all.end(), 0);
  coupling::remove_bodies(w, all);
  w.shapes = {};

  dem::LayerSettings s;
  s.layers = p.layers;
  s.low = run.layout.low, s.high = run.layout.high, s.period = run.layout.period;
  s.seed = run.scene.grains.seed;
  GrainBatch left_out;  // poured on top again: no mass is lost
  if (p.layers > 1) {
    s.sink = 0.5 * mean_size(bed);
    dem::LayeredBed layered = dem::duplicate_layers(bed, s);
    bed = std::move(layered.bed);
    for (int k = 0; k < p.bays; ++k)
      left_out.grains.insert(left_out.grains.end(), layered.left_out.begin(),
                             layered.left_out.end());
    left_out.fine = static_cast<int>(left_out.grains.size());
  }
  if (p.bays > 1) {
    const double width = run.layout.period.y();
    bed = dem::duplicate_along(bed, 1, width, p.bays);
    for (dem::Vec3& x : bed.centre) x.y() -= 0.5 * (p.bays - 1) * width;
  }
  run.actors.sample = false;
  run.layout = make_layout(run.scene);
  coupling::add_grains(w, bed.shape, bed.centre, bed.turn, run.scene.grains.density, kGrain);
  if (left_out.fine > 0) pour_grains(run, left_out, false);
  run.stage.grain_force.assign(w.bodies.grains, 0.0);
  add_walls(run);
}

}  // namespace trackbed::apps
