// A patch with grains on it, for tests: meshes of quads, one evaluation, and the steps of a scene
// whose only contacts are grains on the patch.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "dem/grain/random.h"
#include "dem/motion/energy.h"
#include "dem/surface/patch.h"
#include "dem/surface/patch_forces.h"
#include "dem/surface/rigid.h"

namespace trackbed::dem {

struct Mesh {
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 4>> quads;
};

/// nx x ny quads over [low, high], looking up.
inline Mesh flat_mesh(int nx, int ny, double low_x, double high_x, double low_y, double high_y) {
  Mesh m;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      m.nodes.push_back({low_x + (high_x - low_x) * i / nx, low_y + (high_y - low_y) * j / ny, 0});
  const auto id = [&](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      m.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
  return m;
}

/// A level mesh over [-1, 1], nodes inside pushed about in the plane: a path crosses edges, nodes
/// and diagonals.
inline Mesh uneven_mesh(int nx, int ny) {
  Mesh m = flat_mesh(nx, ny, -1, 1, -1, 1);
  Random random(2);
  const double most = .2 * 2 / std::max(nx, ny);
  for (Vec3& p : m.nodes)
    if (std::abs(p.x()) < .9 && std::abs(p.y()) < .9)
      p += Vec3(random.uniform(-most, most), random.uniform(-most, most), 0);
  return m;
}

/// A level mesh whose nodes are pushed up and down, as a bent FE surface has them.
inline Mesh wavy_mesh(int n, double height) {
  Mesh m = flat_mesh(n, n, -1, 1, -1, 1);
  Random random(4);
  for (Vec3& p : m.nodes) p += Vec3(0, 0, height * random.uniform(-1, 1));
  return m;
}

/// The flat mesh folded down by 90 degrees along x = 0, as at a sleeper's edge: what lies at x > 0
/// becomes the side below the edge.
inline Mesh edge_mesh(int nx, int ny, double half) {
  Mesh m = flat_mesh(2 * nx, ny, -half, half, -half, half);
  for (Vec3& p : m.nodes)
    if (p.x() > 0) p = Vec3(0, p.y(), -p.x());
  return m;
}

/// The same by `angle`, the side below the edge first in number.
inline Mesh folded_mesh(int n, double half, double angle) {
  Mesh m = flat_mesh(2 * n, n, -half, half, -half, half);
  std::stable_partition(m.quads.begin(), m.quads.end(),
                        [&](const auto& q) { return m.nodes[q[1]].x() > 1e-9; });
  for (Vec3& p : m.nodes)
    if (p.x() > 0) p = Vec3(p.x() * std::cos(angle), p.y(), -p.x() * std::sin(angle));
  return m;
}

struct PatchScene {
  ShapeTable shapes;
  Bodies bodies;
  PairMaterials materials{1};
  SurfacePatch patch;
  PatchContacts contacts;
  EvaluatePatch law = nullptr;
  StepContext context;
  std::vector<double> travel;
  double skin = .01, time = 0;
  std::function<void(PatchScene&)> drive;

  PatchScene(const Mesh& m, double shell, double skirt, double modulus, double friction = 0,
             const std::string& name = "stored_energy", const Vec3& period = Vec3::Zero()) {
    PairMaterial pair;
    pair.modulus = modulus, pair.friction = friction, pair.tangential_ratio = .25;
    materials.set(0, 0, pair);
    patch = make_patch("patch", 0, m.nodes, m.quads, shell, skirt, period);
    law = make_patch_forces(name, friction > 0);
    context.period = period;
  }

  int add(const Polyhedron& body, double rho, const Vec3& x, const Quat& q = Quat::Identity(),
          std::uint8_t freedom = kFree) {
    const GrainShape s = make_grain_shape(body);
    travel.push_back(0);
    return add_grain(bodies, shapes, shapes.add(s), 0, rho, x + q * s.origin, q * s.turn, freedom);
  }

  void evaluate(double dt) {
    StepContext c = context;
    c.dt = dt;
    for (int i = 0; i < bodies.size(); ++i) bodies.force[i].setZero(), bodies.torque[i].setZero();
    law(bodies, shapes, materials, c, travel, patch, contacts);
    sum_patch_forces(contacts, bodies, patch);
  }
  /// Where everything stands, without a past.
  void evaluate_afresh() {
    contacts = PatchContacts();
    search_patch(bodies, shapes, patch, context, skin, contacts);
    evaluate(0);
  }
  void place(int i, const Vec3& x, const Quat& q) {
    bodies.x[i] = x;
    bodies.q[i] = q;
    bodies.R[i] = q.toRotationMatrix();
  }
  void step() {
    drift(bodies, context);
    time += context.dt;
    if (drive) drive(*this);
    bool again = false;
    for (int i = 0; i < bodies.size(); ++i) {
      const double before = travel[i];
      travel[i] += bodies.v[i].norm() * context.dt +
                   shapes.view(bodies.shape[i]).radius * bodies.turn[i].norm();
      again |= std::floor(2 * before / skin) != std::floor(2 * travel[i] / skin);
    }
    if (again) search_patch(bodies, shapes, patch, context, skin, contacts);
    evaluate(context.dt);
    kick(bodies, context);
  }
  double energy() const {
    double sum = 0;
    for (const double u : contacts.energy) sum += u;
    return sum;
  }
  Vec3 nodal_sum() const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& f : patch.force) sum += f;
    return sum;
  }
};

inline void turn_mesh(Mesh& m, const Quat& q) {
  for (Vec3& p : m.nodes) p = q * p;
}

}  // namespace trackbed::dem
