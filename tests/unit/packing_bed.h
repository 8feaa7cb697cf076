// Forty stones at rest in a box. All bodies are of one material, walls too. Copying a bed keeps its
// state.
#pragma once
#include "dem/grain/library.h"
#include "dem/packing/equilibrium.h"
#include "dem/packing/lower.h"
#include "dem/packing/packed_grains.h"
#include "dem/packing/place.h"
#include "motion_scene.h"

namespace trackbed::dem {

struct RealBed {
  Scene scene;
  double area = 0.1 * 0.1;

  explicit RealBed(double mu, int seed = 3) : scene(2e6, 0.5) {
    LibraryParameters p;
    p.count = 40;
    p.method = SieveMethod::equal_cube;
    std::vector<GrainShape> shapes = make_library(p);
    std::vector<double> radii;
    for (auto& g : shapes) g = scaled(g, 0.025), radii.push_back(g.radius);
    PlacementSpace space;
    space.low = {0, 0, 0}, space.high = {0.1, 0.1, 0};
    const Placement placed = place_loose(radii, space, {}, 20, seed);
    PackedGrains grains;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      grains.add(shapes[i], placed.centre[i], placed.turn[i]);
    fill(grains);
    lower_grains(scene.bodies, scene.shapes, 0, 0, Vec3::Zero(), 1e-4);
    settle(mu);
  }
  /// Grains that are somewhere already; they do not move yet.
  explicit RealBed(const PackedGrains& grains) : scene(2e6, 0.5) { fill(grains); }

  void fill(const PackedGrains& grains) {
    for (int i = 0; i < grains.size(); ++i)
      add_grain(scene.bodies, scene.shapes, scene.shapes.add(grains.shape[i]), 0, 2600,
                grains.centre[i], grains.turn[i]);
    add_container(scene.bodies, scene.shapes, {0, 0, 0}, {0.1, 0.1, 1}, 0.1, 0);
    scene.context.local_damping = 0.7;
  }
  void set_friction(double mu) {
    PairMaterial m;
    m.modulus = 2e6, m.friction = mu, m.tangential_ratio = 0.25;
    scene.materials.set(0, 0, m);
  }
  double settle(double mu, double stop_at = 0, double friction_then = 0) {
    set_friction(mu);
    scene.prepare();
    scene.context.dt = 0.8 * expected_limit(scene.bodies, scene.shapes, scene.materials, {}).dt;
    for (int k = 0; k < 40000; ++k) {
      scene.step();
      if (stop_at > 0 && k % 10 == 9 && porosity() < stop_at)
        set_friction(friction_then), stop_at = 0;
      if (k % 100 == 99 && k > 1000 &&
          unbalanced_share(scene.bodies, scene.pairs, scene.context.gravity) < 5e-3)
        break;
    }
    return porosity();
  }
  double porosity() const { return measure_bed(scene.bodies, scene.shapes, area, 0).porosity; }
};

}  // namespace trackbed::dem
