#include "fem/elastic_body.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/body_model.h"
#include "fem/contact_bound.h"
#include "fem/frequencies.h"
#include "fem/output.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

struct Totals {
  double work_loads = 0, work_surface = 0, damping = 0, boundary = 0, at_start = 0;
};

double inner(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

struct ElasticBody::Parts : BodyModel {
  Stepper stepper;
  std::unique_ptr<LinearSolver> statics;  // of the stiffness, when first needed
  std::unique_ptr<LinearSolver> inertia;  // of the mass, likewise

  Motion motion;
  std::vector<double> load, load_before;  // resultants [N]: from the next step on, and at t
  std::vector<Vec> surface_before;        // contact forces at t
  Totals totals;
  // Work space of a step.
  std::vector<double> force, u_before, v_before, product;

  explicit Parts(ElasticBodyParameters given)
      : BodyModel(std::move(given)),
        stepper(assembled.matrices,
                make_scheme(p.scheme, p.newmark ? newmark() : generalised_alpha(p.rho_inf)),
                p.solver) {
    if (const std::string free = free_motion(); is_static() && !free.empty())
      throw InputError(text(p.name, ": not held: it can still ", free,
                            ", so quasi_static cannot carry it; add supports or a bed"));
    for (auto* field : {&motion.u, &motion.v, &motion.a, &motion.f, &force, &u_before})
      field->assign(unknowns.count, 0.);
    load.assign(patches.size(), 0.);
    load_before = load;
    surface_before.assign(surface.node.size(), Vec{});
  }

  double gravity_potential() const {
    if (!has_gravity()) return 0;
    double energy = 0;
    for (int i = 0; i < body.nodes(); ++i)
      energy -= assembled.node_mass[i] * inner(p.gravity, at(motion.u, i));
    return energy;
  }
  // M⁻¹ of forces on the surface, there.
  void push(const std::vector<Vec>& forces, std::vector<Vec>& accelerations) {
    if (!inertia)
      inertia = std::make_unique<LinearSolver>(matrices().pattern, matrices().mass, "mass matrix",
                                               p.solver);
    std::vector<double> f(unknowns.count, 0.), a(unknowns.count, 0.);
    add_surface(forces, f);
    inertia->solve(f, a);
    for (std::size_t i = 0; i < surface.node.size(); ++i) accelerations[i] = at(a, surface.node[i]);
  }
  bool is_static() const { return p.scheme == TimeScheme::quasi_static; }
  double kinetic() const { return is_static() ? 0 : product_of(matrices().mass, motion.v) / 2; }
  double strain() const { return product_of(matrices().stiffness, motion.u) / 2; }
  double product_of(const std::vector<double>& A, const std::vector<double>& x) const {
    return fem::product(matrices().pattern, A, x, x);
  }
  void start_ledger() {
    totals = {};
    totals.at_start = kinetic() + strain() + gravity_potential();
  }
};

ElasticBody::ElasticBody(ElasticBodyParameters p) : parts_(new Parts(std::move(p))) {
  Parts& s = *parts_;
  if (!s.has_gravity()) return;
  if (s.p.start_in_equilibrium && s.free_motion().empty()) {
    solve_static();
  } else {
    s.outer_force(s.load, s.motion.f);
    s.stepper.set_acceleration(s.motion);
    s.start_ledger();
  }
}

ElasticBody::~ElasticBody() = default;

const SurfaceMesh& ElasticBody::surface() const { return parts_->surface.mesh; }
const ElasticBodyParameters& ElasticBody::parameters() const { return parts_->p; }
void ElasticBody::set_step(double dt) { parts_->stepper.set_step(dt); }
double ElasticBody::explicit_limit() const { return parts_->stepper.explicit_limit(); }
bool ElasticBody::is_explicit() const { return parts_->stepper.is_explicit(); }

void ElasticBody::predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  const Parts& s = *parts_;
  const double dt = s.stepper.step();
  const std::size_t n = s.surface.node.size();
  displacement.resize(n);
  velocity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& ids = s.unknowns.of_node[s.surface.node[i]];
    for (int d = 0; d < 3; ++d) {
      const int k = ids[d];
      displacement[i][d] = k < 0 ? 0. : s.stepper.predicted(s.motion, k);
      velocity[i][d] = k < 0 ? 0. : s.motion.v[k] + dt * s.motion.a[k];
    }
  }
}

void ElasticBody::motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  const Parts& s = *parts_;
  displacement.resize(s.surface.node.size());
  velocity.resize(s.surface.node.size());
  for (std::size_t i = 0; i < s.surface.node.size(); ++i) {
    displacement[i] = s.at(s.motion.u, s.surface.node[i]);
    velocity[i] = s.at(s.motion.v, s.surface.node[i]);
  }
}

void ElasticBody::advance(const std::vector<Vec>& forces) {
  Parts& s = *parts_;
  s.check(forces);
  s.outer_force(s.load, s.force);
  s.add_surface(forces, s.force);
  s.u_before = s.motion.u;
  const bool damped = !s.matrices().damping.empty() && !s.is_static();
  if (damped) s.v_before = s.motion.v;
  s.stepper.advance(s.motion, s.force);

  for (std::size_t i = 0; i < s.u_before.size(); ++i) s.u_before[i] = s.motion.u[i] - s.u_before[i];
  const std::vector<double>& moved = s.u_before;  // u₊ − u
  double work = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Vec du = s.at(moved, s.surface.node[i]);
    for (int d = 0; d < 3; ++d) work += (s.surface_before[i][d] + forces[i][d]) * du[d];
    s.surface_before[i] = forces[i];
  }
  s.totals.work_surface += work / 2;
  for (std::size_t l = 0; l < s.patches.size(); ++l) {
    const double sum = s.load_before[l] + s.load[l];
    if (sum != 0)
      s.totals.work_loads += sum / 2 * inner(s.patches[l].direction, s.patch_mean(l, moved));
    s.load_before[l] = s.load[l];
  }
  if (damped) {
    std::vector<double>& mean = s.v_before;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (mean[i] + s.motion.v[i]) / 2;
    multiply(s.matrices().pattern, s.matrices().damping, mean, s.product);
    double boundary = 0;
    for (const BoundaryDashpot& c : s.assembled.dashpots)
      boundary += moved[c.row] * c.value * mean[c.column];
    s.totals.boundary += boundary;
    s.totals.damping += dot(moved, s.product) - boundary;
  }
}

int ElasticBody::loads() const { return static_cast<int>(parts_->patches.size()); }
void ElasticBody::set_load(int load, double newton) {
  if (!std::isfinite(newton))
    throw RunError(
        text(parts_->p.name, ": load '", parts_->p.loads.at(load).name, "' is not finite"));
  parts_->load.at(load) = newton;
}
Vec ElasticBody::load_displacement(int load) const {
  return parts_->patch_mean(load, parts_->motion.u);
}

double ElasticBody::mass() const { return parts_->mass(); }
double ElasticBody::least_surface_mass() const {
  return parts_->is_static() ? std::numeric_limits<double>::infinity()
                             : parts_->least_surface_mass();
}
double ElasticBody::largest_frequency() const { return fem::largest_frequency(parts_->matrices()); }
double ElasticBody::contact_bound(const std::vector<NodeSpring>& springs) const {
  Parts& s = *parts_;
  if (is_explicit()) {
    const double own = (std::isfinite(largest_step()) ? 2 : 0.9 * 2) / explicit_limit();  // omega
    return Structure::contact_bound(springs) + own * own;
  }
  if (s.is_static() || !s.matrices().lumped.empty()) return Structure::contact_bound(springs);
  return largest_contact_eigenvalue(springs, static_cast<int>(s.surface.node.size()),
                                    [&](const auto& forces, auto& a) { s.push(forces, a); });
}
double ElasticBody::largest_step() const { return parts_->stepper.largest_step(); }
int ElasticBody::solver_iterations() const { return parts_->stepper.iterations(); }
int ElasticBody::unknowns() const { return parts_->unknowns.count; }

StructureEnergy ElasticBody::energy() const {
  const Parts& s = *parts_;
  StructureEnergy e;
  e.kinetic = s.kinetic();
  e.strain = s.strain();
  e.gravity = s.gravity_potential();
  e.work_loads = s.totals.work_loads;
  e.work_surface = s.totals.work_surface;
  e.dissipated_damping = s.totals.damping;
  e.dissipated_boundary = s.totals.boundary;
  e.at_start = s.totals.at_start;
  e.numerical = e.work_loads + e.work_surface + e.at_start - e.kinetic - e.strain - e.gravity -
                e.dissipated_damping - e.dissipated_boundary;
  return e;
}

void ElasticBody::save(std::vector<double>& state) const {
  const Parts& s = *parts_;
  state.clear();
  const auto put = [&](const std::vector<double>& values) {
    state.insert(state.end(), values.begin(), values.end());
  };
  for (const auto* field :
       {&s.motion.u, &s.motion.v, &s.motion.a, &s.motion.f, &s.load, &s.load_before})
    put(*field);
  for (const Vec& f : s.surface_before) state.insert(state.end(), f.begin(), f.end());
  put({s.totals.work_loads, s.totals.work_surface, s.totals.damping, s.totals.boundary,
       s.totals.at_start});
  put(s.motion.a_before);
}

void ElasticBody::load(const std::vector<double>& state) {
  Parts& s = *parts_;
  const std::size_t expected =
      4 * s.motion.u.size() + 2 * s.load.size() + 3 * s.surface_before.size() + 5;
  const bool has_before = state.size() == expected + s.motion.a.size();  // of Zhai
  if (state.size() != expected && !(has_before && s.p.scheme == TimeScheme::zhai))
    throw InputError(text(s.p.name, ": the saved state has ", state.size(),
                          " numbers, this body needs ", expected, "; it belongs to another mesh"));
  auto from = state.begin();
  const auto get = [&](std::vector<double>& values) {
    std::copy_n(from, values.size(), values.begin());
    from += static_cast<std::ptrdiff_t>(values.size());
  };
  for (auto* field : {&s.motion.u, &s.motion.v, &s.motion.a, &s.motion.f, &s.load, &s.load_before})
    get(*field);
  for (Vec& f : s.surface_before)
    for (double& c : f) c = *from++;
  s.totals = {from[0], from[1], from[2], from[3], from[4]};
  if (has_before)
    s.motion.a_before.assign(from + 5, state.end());
  else
    s.motion.a_before.clear();
}

void ElasticBody::translate(const Vec& by) {
  Parts& s = *parts_;
  shift(s.grid, by);
  for (auto* places : {&s.body.position, &s.surface.mesh.nodes})
    for (Vec& x : *places)
      for (int d = 0; d < 3; ++d) x[d] += by[d];
}

void ElasticBody::set_velocity(const Vec& velocity) {
  Parts& s = *parts_;
  for (const auto& ids : s.unknowns.of_node)
    for (int d = 0; d < 3; ++d)
      if (ids[d] >= 0) s.motion.v[ids[d]] = velocity[d];
  s.outer_force(s.load, s.motion.f);
  s.load_before = s.load;
  std::fill(s.surface_before.begin(), s.surface_before.end(), Vec{});
  s.stepper.set_acceleration(s.motion);
  s.start_ledger();
}

void ElasticBody::solve_static(const std::vector<Vec>& forces) {
  Parts& s = *parts_;
  const std::string free = s.free_motion();
  if (!free.empty())
    throw InputError(text(s.p.name, ": not held: it can still ", free,
                          ", so a static answer does not exist; add supports or a bed"));
  s.outer_force(s.load, s.motion.f);
  std::fill(s.surface_before.begin(), s.surface_before.end(), Vec{});
  if (!forces.empty()) {
    s.check(forces);
    s.add_surface(forces, s.motion.f);
    s.surface_before = forces;
  }
  s.load_before = s.load;
  if (!s.statics)
    s.statics = std::make_unique<LinearSolver>(s.matrices().pattern, s.matrices().stiffness,
                                               s.p.name.c_str(), s.p.solver, s.matrices().rigid);
  s.statics->solve(s.motion.f, s.motion.u);
  std::fill(s.motion.v.begin(), s.motion.v.end(), 0.);
  std::fill(s.motion.a.begin(), s.motion.a.end(), 0.);
  s.start_ledger();
}

Vec ElasticBody::displacement_at(const Vec& point) const {
  const Parts& s = *parts_;
  return field_at(s.p, s.grid, s.everywhere(s.motion.u), point);
}

Vec ElasticBody::momentum() const {
  const Parts& s = *parts_;
  Vec sum{};
  for (int i = 0; i < s.body.nodes(); ++i) {
    const Vec v = s.at(s.motion.v, i);
    for (int d = 0; d < 3; ++d) sum[d] += s.assembled.node_mass[i] * v[d];
  }
  return sum;
}

Vec ElasticBody::reaction() const {
  const Parts& s = *parts_;
  Vec sum{};
  for (int i = 0; i < s.body.nodes(); ++i) {
    const Vec a = s.at(s.motion.a, i);
    for (int d = 0; d < 3; ++d) sum[d] += s.assembled.node_mass[i] * (a[d] - s.p.gravity[d]);
  }
  for (std::size_t l = 0; l < s.patches.size(); ++l)
    for (int d = 0; d < 3; ++d) sum[d] -= s.load_before[l] * s.patches[l].direction[d];
  for (const Vec& f : s.surface_before)
    for (int d = 0; d < 3; ++d) sum[d] -= f[d];
  return sum;
}

std::vector<double> ElasticBody::frequencies(int count) const {
  return lowest_frequencies(parts_->matrices(), count);
}

void ElasticBody::write_vtu(const std::string& file) const {
  const Parts& s = *parts_;
  write_fields(file, s.p, s.grid, s.body, s.everywhere(s.motion.u), s.everywhere(s.motion.v));
}

}  // namespace trackbed::fem
