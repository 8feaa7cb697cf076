// Worlds with deforming surfaces, for tests: a structure of one mass on a spring, and grains on an
// elastic block.
#pragma once
#include <memory>

#include "base/error.h"
#include "coupling/edit.h"
#include "coupling/time_step.h"
#include "coupling/world.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "dem/motion/energy.h"
#include "dem/surface/rigid.h"
#include "fem/elastic_body.h"

namespace trackbed::coupling {

using dem::Quat;
using dem::Vec3;

/// One mass m on a ground spring k that carries a flat square of four nodes, up and down only;
/// Newmark (1/4, 1/2) or velocity Verlet.
class MassOnSpring final : public fem::Structure {
 public:
  MassOnSpring(double m, double k, double half_width, bool verlet) : m_(m), k_(k), verlet_(verlet) {
    const double h = half_width;
    mesh_.nodes = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
    mesh_.quads = {{0, 1, 2, 3}};
    mesh_.edges = {{fem::Edge::border, fem::Edge::border, fem::Edge::border, fem::Edge::border}};
    mesh_.boundary = {0};
    mesh_.same_as = {0, 1, 2, 3};
  }
  double u = 0, v = 0, a = 0;

  const fem::SurfaceMesh& surface() const override { return mesh_; }
  void set_step(double dt) override { dt_ = dt; }
  double explicit_limit() const override { return verlet_ ? 2 / largest_frequency() : 0; }
  void predict(std::vector<fem::Vec>& x, std::vector<fem::Vec>& speed) const override {
    x.assign(4, {0, 0, u + dt_ * (v + dt_ / 2 * a)});
    speed.assign(4, {0, 0, v + dt_ * a});
  }
  void advance(const std::vector<fem::Vec>& forces) override {
    double f = 0;
    for (const auto& p : forces) f += p[2];
    const double end = u + dt_ * (v + dt_ / 2 * a);
    const double next =
        verlet_ ? (f - k_ * end) / m_
                : (f - k_ * (u + dt_ * v + dt_ * dt_ / 4 * a)) / (m_ + k_ * dt_ * dt_ / 4);
    u = verlet_ ? end : u + dt_ * v + dt_ * dt_ / 4 * (a + next);
    v += dt_ / 2 * (a + next);
    a = next;
  }
  void motion(std::vector<fem::Vec>& x, std::vector<fem::Vec>& speed) const override {
    x.assign(4, {0, 0, u});
    speed.assign(4, {0, 0, v});
  }
  int loads() const override { return 0; }
  void set_load(int, double) override {}
  fem::Vec load_displacement(int) const override { return {}; }
  double mass() const override { return m_; }
  double least_surface_mass() const override { return m_ / 4; }
  double largest_frequency() const override { return std::sqrt(k_ / m_); }
  int unknowns() const override { return 1; }
  fem::StructureEnergy energy() const override {
    fem::StructureEnergy e;
    e.kinetic = m_ * v * v / 2;
    e.strain = k_ * u * u / 2;
    return e;
  }
  void save(std::vector<double>& state) const override { state = {u, v, a}; }
  void load(const std::vector<double>& s) override { u = s[0], v = s[1], a = s[2]; }

 private:
  double m_, k_, dt_ = 0;
  bool verlet_;
  fem::SurfaceMesh mesh_;
};

inline void set_materials(World& w, double modulus, double friction, int materials = 1) {
  w.materials = dem::PairMaterials(materials);
  dem::PairMaterial m;
  m.modulus = modulus, m.friction = friction, m.tangential_ratio = .25;
  for (int i = 0; i < materials; ++i)
    for (int j = 0; j < materials; ++j) w.materials.set(i, j, m);
  w.pair_forces = dem::make_pair_forces("stored_energy", friction > 0);
  w.patch_forces = dem::make_patch_forces("stored_energy", friction > 0);
}

inline int add_grain(World& w, const dem::Polyhedron& body, double rho, const Vec3& x,
                     const Quat& q = Quat::Identity(), std::uint8_t freedom = dem::kFree) {
  const dem::GrainShape s = dem::make_grain_shape(body);
  return dem::add_grain(w.bodies, w.shapes, w.shapes.add(s), 0, rho, x + q * s.origin, q * s.turn,
                        freedom);
}

/// An elastic block whose top is at z = 0; held at its base unless it is free.
inline fem::ElasticBodyParameters block(double young, const Vec3& lengths,
                                        const std::array<int, 3>& cells, bool held = true,
                                        double damping = 0) {
  fem::ElasticBodyParameters p;
  p.mesh.corner = {-lengths.x() / 2, -lengths.y() / 2, -lengths.z()};
  p.mesh.lengths = {lengths.x(), lengths.y(), lengths.z()};
  p.mesh.elements = {cells[0], cells[1], cells[2]};
  fem::Material m;
  m.name = "soil", m.young = young, m.poisson = .3, m.density = 2000, m.rayleigh_mass = damping;
  p.materials = {m};
  if (held) p.supports["bottom"] = fem::Support::fixed;
  p.contact = {"top"};
  return p;
}

inline dem::StepContext context(double dt, const Vec3& gravity, int threads = 1) {
  dem::StepContext c;
  c.dt = dt, c.gravity = gravity, c.threads = threads;
  return c;
}

/// prepare() where no step led to, and the ledger opened.
inline void start(World& w, const dem::StepContext& c) {
  dem::StepContext still = c;
  still.dt = 0;
  set_step(w, c.dt);
  prepare(w, still);
  open_ledger(w, c.gravity);
}

inline void run(World& w, const dem::StepContext& c, int steps) {
  for (int k = 0; k < steps; ++k) advance(w, c, [](World&, double) {});
}

/// n x n x layers Voronoi grains of about 50 mm above an elastic block between four walls.
inline World bed(int n, int layers, double young = 5e7) {
  World w;
  set_materials(w, 2e8, .5);
  dem::VoronoiParameters v;
  v.count = n * n * layers;
  const auto grains = dem::voronoi_grains(v);
  const double d = .05, half = .6 * n * d;
  dem::Random random(7);
  for (int k = 0; k < n * n * layers; ++k) {
    dem::Polyhedron body = grains[k];
    for (Vec3& p : body.vertices) p *= .8 * d;
    const Vec3 at((k % n - .5 * (n - 1)) * 1.15 * d, (k / n % n - .5 * (n - 1)) * 1.15 * d,
                  .75 * d + 1.15 * d * (k / n / n));
    add_grain(w, body, 2600, at, Quat(Eigen::AngleAxisd(random.uniform(0, 6), random.direction())));
  }
  dem::add_container(w.bodies, w.shapes, {-half, -half, -.1}, {half, half, 2}, .1, 0,
                     dem::kLowX | dem::kHighX | dem::kLowY | dem::kHighY);
  w.surfaces.push_back(make_surface(
      "subgrade", 0, .01, .05, Vec3::Zero(),
      std::make_unique<fem::ElasticBody>(block(young, {2 * half, 2 * half, .15}, {5, 5, 2}))));
  return w;
}

}  // namespace trackbed::coupling
