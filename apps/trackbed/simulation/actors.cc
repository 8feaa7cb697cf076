#include "apps/trackbed/simulation/actors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/structures.h"
#include "base/error.h"
#include "coupling/edit.h"
#include "dem/grain/random.h"
#include "dem/packing/lower.h"
#include "dem/packing/packed_grains.h"
#include "dem/packing/place.h"
#include "dem/surface/rigid.h"
#include "fem/distributed_body.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

constexpr double kClearance = 1e-4;  // between things put in and what is there [m]
constexpr double kPlateGap = 5e-3;   // between plate and walls [m]

double largest_sieve(const dem::ShapeTable& shapes) {
  double largest = 0;
  for (int k = 0; k < shapes.size(); ++k) largest = std::max(largest, shapes.shape(k).sieve_size);
  return largest;
}

// Deeper than the deepest overlap that the run allows, of its largest grain.
double shell_depth(const Run& run) {
  return 1.2 * run.scene.contact.largest_overlap * largest_sieve(run.world.shapes);
}

}  // namespace

double highest_grain(const Run& run, double low_x, double high_x, double low_y, double high_y) {
  const dem::Bodies& b = run.world.bodies;
  double top = 0;
  for (int i = 0; i < b.grains; ++i)
    for (const Vec3& p : run.world.shapes.shape(b.shape[i]).body.vertices) {
      const Vec3 x = b.x[i] + b.R[i] * p;
      if (x.x() > low_x && x.x() < high_x && x.y() > low_y && x.y() < high_y)
        top = std::max(top, x.z());
    }
  return top;
}

void pour_grains(Run& run, const GrainBatch& batch, bool beside) {
  coupling::World& w = run.world;
  const Layout& l = run.layout;
  const ContainerScene& c = run.scene.container;
  dem::PlacementSpace space;
  space.low = l.low, space.high = l.high;
  space.period = l.period;
  if (c.shape == "cylinder") space.radius = dem::prism_apothem(0.5 * c.length, c.sides);
  if (!batch.zone.empty()) space.zones = zone_rectangles(run.scene, l);
  dem::PlacedSpheres present;
  if (beside) {
    space.blocks.push_back(
        {{l.sleeper_low_x, l.sleeper_low_y, 0}, {l.sleeper_high_x, l.sleeper_high_y, 0}});
    // Onto the crest of the shoulders; what rolls off it is trimmed.
    const double crest = half_width(run.scene, 0, c.fill_height);
    space.low.x() = std::max(space.low.x(), -crest);
    space.high.x() = std::min(space.high.x(), crest);
  }
  for (int i = 0; i < w.bodies.grains; ++i) {
    present.centre.push_back(w.bodies.x[i]);
    present.radius.push_back(w.shapes.shape(w.bodies.shape[i]).radius);
  }
  // Fine and coarse grains come down in turn, or a mixed zone would be layered.
  const int count = static_cast<int>(batch.grains.size());
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  if (!batch.zone.empty()) dem::Random(run.scene.grains.seed).shuffle(order);
  std::vector<double> radii;
  std::vector<int> zone;
  for (const int i : order) {
    radii.push_back(batch.grains[i].radius);
    if (!batch.zone.empty()) zone.push_back(batch.zone[i]);
  }
  const dem::Placement p =
      dem::place_loose(radii, space, present, 40, run.scene.grains.seed + (beside ? 77 : 0), zone);
  dem::PackedGrains fine, coarse;
  for (int k = 0; k < count; ++k)
    (order[k] < batch.fine ? fine : coarse).add(batch.grains[order[k]], p.centre[k], p.turn[k]);
  const int before = w.bodies.grains;
  const double density = run.scene.grains.density;
  coupling::add_grains(w, fine.shape, fine.centre, fine.turn, density, kGrain);
  coupling::add_grains(w, coarse.shape, coarse.centre, coarse.turn, density, kCoarseGrain);
  dem::lower_grains(w.bodies, w.shapes, before, 0, l.period, kClearance);
}

void add_walls(Run& run) {
  const ContainerScene& c = run.scene.container;
  const Layout& l = run.layout;
  dem::Bodies& b = run.world.bodies;
  dem::ShapeTable& shapes = run.world.shapes;
  const Vec3 low = l.low - Vec3(0, 0, wall_thickness), high(l.high.x(), l.high.y(), wall_top);
  const int before = b.size();
  // Walls reach below the floor and the floor beyond the walls, so that edges are closed.
  const auto side = [&](unsigned which, int material) {
    dem::add_container(b, shapes, low, high, wall_thickness, material, which);
  };
  if (c.shape == "cylinder") {
    dem::add_round_wall(b, shapes, 0.5 * (l.low + l.high), 0.5 * c.length, low.z(), high.z(),
                        wall_thickness, kWall, c.sides);
  } else {
    side(dem::kLowX, c.half ? kMirror : kWall);
    side(dem::kHighX, kWall);
    if (!c.periodic) side(dem::kLowY | dem::kHighY, kWall);
  }
  dem::add_container(b, shapes, l.low, high, wall_thickness, kSubgrade, dem::kBase);
  run.actors.walls = b.size() - before;
  run.actors.floor = true;
}

void add_plate(Run& run) {
  const Layout& l = run.layout;
  const PackingScene& p = run.scene.packing;
  Vec3 low = l.low, high = l.high;
  for (int k = 0; k < 2; ++k) {
    const double gap = l.period[k] > 0 ? 0 : kPlateGap;
    low[k] += gap, high[k] -= gap;
  }
  low.z() = highest_grain(run, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL) + kClearance;
  high.z() = low.z() + p.plate_thickness;
  const ContainerScene& c = run.scene.container;
  if (c.shape == "cylinder") {
    const dem::Polyhedron disc =
        dem::make_round_prism(0.5 * c.length - kPlateGap, p.plate_thickness, c.sides);
    dem::add_rigid_body(run.world.bodies, run.world.shapes, disc, kPlate,
                        p.plate_density * dem::mass_properties(disc).volume, {0, 0, low.z()},
                        dem::Quat::Identity(), dem::kMoveZ);
  } else {
    dem::add_box(run.world.bodies, run.world.shapes, low, high, kPlate,
                 p.plate_density * (high - low).prod(), dem::kMoveZ);
  }
  run.actors.plate = true;
}

double sleeper_base_on(const Run& run) {
  const Layout& l = run.layout;
  return kClearance +
         highest_grain(run, l.sleeper_low_x, l.sleeper_high_x, l.sleeper_low_y, l.sleeper_high_y);
}

void add_rigid_sleeper(Run& run) {
  const Layout& l = run.layout;
  const SleeperScene& s = run.scene.sleeper;
  const double base = sleeper_base_on(run);
  const Vec3 low(l.sleeper_low_x, l.sleeper_low_y, base);
  const Vec3 high(l.sleeper_high_x, l.sleeper_high_y, base + s.height);
  const double pad = s.pad_thickness / s.height;
  const double density = (1 - pad) * s.density + pad * s.pad_density;
  const int i = dem::add_box(run.world.bodies, run.world.shapes, low, high, kSleeper,
                             density * (high - low).prod(), dem::kMoveZ);
  run.actors.rigid_sleeper = true;
  run.actors.sleeper_base = base;
  run.actors.sleeper_start = run.world.bodies.x[i].z();
}

void remove_moving_body(Run& run) {
  coupling::remove_bodies(run.world, {moving_body(run)});
  run.actors.plate = run.actors.rigid_sleeper = false;
}

void trim_shoulders(Run& run) {
  if (run.scene.container.shoulder_width == 0) return;
  const dem::Bodies& b = run.world.bodies;
  const double base = run.actors.rigid_sleeper ? run.actors.sleeper_base : sleeper_base_on(run);
  std::vector<int> outside;
  for (int i = 0; i < b.grains; ++i) {
    const Vec3& x = b.x[i];
    if (std::abs(x.x()) > half_width(run.scene, base, x.z()) ||
        x.z() > base + run.scene.container.fill_height)
      outside.push_back(i);
  }
  coupling::remove_bodies(run.world, outside);
}

void build_structures(Run& run) {
  coupling::World& w = run.world;
  w.surfaces.clear();
  run.actors.sleeper_surface = run.actors.subgrade_surface = -1;
  const double depth = shell_depth(run);
  std::unique_ptr<fem::Structure> sleeper, subgrade;
  {
    // All of them before any is asked for its motion: under mpirun the other ranks build as many in
    // a row, and serve the asking only then.
    fem::ask_to_build(0, run.actors.sleeper_base);
    const fem::BuildingTogether together;
    if (run.scene.sleeper.model != "rigid")
      sleeper = make_elastic_sleeper(run.scene, run.layout, run.actors.sleeper_base);
    if (run.scene.subgrade.model != "rigid")
      subgrade = make_subgrade_structure(run.scene, run.layout);
  }
  if (sleeper) {
    run.actors.sleeper_surface = static_cast<int>(w.surfaces.size());
    w.surfaces.push_back(
        coupling::make_surface("sleeper", kSleeper, depth, 0, {0, 0, 0}, std::move(sleeper)));
  }
  if (subgrade) {
    run.actors.subgrade_surface = static_cast<int>(w.surfaces.size());
    w.surfaces.push_back(coupling::make_surface("subgrade", kSubgrade, depth,
                                                largest_sieve(w.shapes), run.layout.period,
                                                std::move(subgrade)));
  }
}

void place_structures(Run& run) {
  coupling::World& w = run.world;
  const int sleeper = moving_body(run), floor = sleeper - 1;
  // The sleeper has come down since it was put in; what replaces it starts where it lies.
  run.actors.sleeper_base += w.bodies.x[sleeper].z() - run.actors.sleeper_start;
  run.actors.sleeper_start = w.bodies.x[sleeper].z();
  build_structures(run);
  if (run.actors.sleeper_surface >= 0)
    remove_moving_body(run);
  else
    w.bodies.freedom[sleeper] = static_cast<std::uint8_t>(
        run.scene.sleeper.freedom &
        (run.scene.container.half ? dem::kMoveY | dem::kMoveZ | dem::kTurnX : dem::kFree));
  if (run.actors.subgrade_surface >= 0) {
    coupling::remove_bodies(w, {floor});
    --run.actors.walls;
    run.actors.floor = false;
  }
}

void apply_load(Run& run, double newton) {
  run.stage.load = newton;
  coupling::World& w = run.world;
  if (run.actors.sleeper_surface >= 0) {
    fem::Structure& s = *w.surfaces[run.actors.sleeper_surface].structure;
    const int seats = seat_loads(run.scene);
    for (int k = 0; k < seats; ++k) s.set_load(k, run.layout.share * newton / seats);
  } else if (run.actors.plate || run.actors.rigid_sleeper) {
    w.bodies.applied_force[moving_body(run)] = Vec3(0, 0, -run.layout.share * newton);
  }
}

void compress_pads(Run& run, double before, double dt) {
  const SleeperScene& s = run.scene.sleeper;
  if (s.rail_pad.stiffness == 0) return;
  const double seats = static_cast<double>(s.seats.size());  // also of a half sleeper: whole loads
  const double now = run.stage.load / seats, start = run.stage.pad;
  before /= seats;
  run.stage.pad = fem::pad_compression(s.rail_pad, start, before, now, dt);
  const double pads = seats * run.layout.share, stored = pads_energy(run);
  const double work = pads * fem::pad_work(s.rail_pad, start, run.stage.pad, before, now, dt);
  run.stage.pad_work += work;
  run.stage.pad_loss += work - (stored - pads * s.rail_pad.stiffness * start * start / 2);
}

double pads_energy(const Run& run) {
  const SleeperScene& s = run.scene.sleeper;
  return static_cast<double>(s.seats.size()) * run.layout.share * s.rail_pad.stiffness *
         run.stage.pad * run.stage.pad / 2;
}

double push_displacement(const Run& run) {
  const int axis = run.scene.loading.push == "lateral" ? 0 : 1;
  const coupling::World& w = run.world;
  if (run.actors.sleeper_surface < 0) return w.bodies.x[moving_body(run)][axis];
  std::vector<fem::Vec> u, v;
  w.surfaces[run.actors.sleeper_surface].structure->motion(u, v);
  double sum = 0;
  for (const fem::Vec& node : u) sum += node[axis];
  return sum / static_cast<double>(u.size());
}

double push_stiffness(const LoadingScene& l, double mass, double dt) {
  return std::min(l.push_stiffness, std::pow(0.01 / dt, 2) * mass);
}

namespace {

// Of the whole sleeper [kg].
double sleeper_mass(const Run& run) {
  const coupling::World& w = run.world;
  const double mass = run.actors.sleeper_surface >= 0
                          ? w.surfaces[run.actors.sleeper_surface].structure->mass()
                          : w.bodies.mass[moving_body(run)];
  return mass / run.layout.share;
}

}  // namespace

void apply_push(Run& run, double target) {
  const int axis = run.scene.loading.push == "lateral" ? 0 : 1;
  StageState& s = run.stage;
  coupling::World& w = run.world;
  const double mass = sleeper_mass(run), speed = run.scene.loading.push_speed;
  const double stiffness = push_stiffness(run.scene.loading, mass, s.dt);
  // Half of critical: the jerk of the start dies away within some of the actuator's own periods.
  const double dashpot = std::sqrt(stiffness * mass);
  s.push_stiffness = stiffness;
  const double before = s.push;
  s.push = push_displacement(run) - s.push_start;
  s.push_force = stiffness * (target - s.push) + dashpot * (speed - (s.push - before) / s.dt);
  const double force = run.layout.share * s.push_force;
  if (run.actors.sleeper_surface >= 0)
    w.surfaces[run.actors.sleeper_surface].structure->set_load(seat_loads(run.scene), force);
  else
    w.bodies.applied_force[moving_body(run)][axis] = force;
}

}  // namespace trackbed::apps
