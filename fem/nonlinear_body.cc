#include "fem/nonlinear_body.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/body_model.h"
#include "fem/cell_points.h"
#include "fem/frequencies.h"
#include "fem/output.h"
#include "fem/text.h"
#include "fem/unsymmetric_solver.h"

namespace trackbed::fem {
namespace {

constexpr int kMostIterations = 30;
constexpr double kConverged = 1e-10;  // residual over the forces

double length(const std::vector<double>& x) { return std::sqrt(dot(x, x)); }

// Mesh and mass; the stiffness comes from the stress model.
ElasticBodyParameters with_density(ElasticBodyParameters p, double density) {
  if (!p.beds.empty())
    throw InputError(p.name + ": absorbing boundaries need an elastic material; none is allowed");
  Material m;
  m.name = "of the stress model";
  m.young = 1, m.poisson = 0, m.density = density;
  p.materials = {m};
  for (Layer& layer : p.mesh.layers) layer.material = 0;
  p.loads.clear();
  p.gravity = {0, 0, 0};
  p.mass = Mass::lumped;
  p.solver = SolverKind::direct;
  return p;
}

}  // namespace

struct NonlinearBody::Parts {
  BodyModel m;
  std::shared_ptr<const StressModel> model;
  CellPoints points;
  Scheme scheme;

  Motion motion;
  std::vector<double> history, inner;  // inner: f_int(u) − f_int(in situ), at t
  std::vector<Vec> surface_before;
  double work = 0, plastic = 0, at_start = 0, stored = 0;
  double dt = 0, limit = 0;

  // Of the last evaluation.
  std::vector<double> new_history, tangent;
  double new_stored = 0, new_plastic = 0;
  std::vector<double> in_situ;
  double stored_in_situ = 0;
  // Work space.
  StressInputs in;
  StressOutputs out;
  std::vector<double> B, u_before, trial;

  Parts(ElasticBodyParameters given, std::shared_ptr<const StressModel> stress)
      : m(with_density(std::move(given), stress->density())),
        model(std::move(stress)),
        points(cell_points(m.grid, m.p.order)),
        scheme(m.p.newmark ? newmark() : generalised_alpha(m.p.rho_inf)) {
    const int n = m.unknowns.count;
    for (auto* field : {&motion.u, &motion.v, &motion.a, &motion.f, &in_situ}) field->assign(n, 0.);
    history.assign(points.weight.size() * model->history(), 0.);
    surface_before.assign(m.surface.node.size(), Vec{});
    tangent.assign(m.matrices().pattern.column.size(), 0.);
    evaluate(motion.u, in_situ, true);
    stored = stored_in_situ = new_stored;
    inner.assign(n, 0.);
    m.assembled.matrices.stiffness = tangent;
    for (std::size_t e = 0; e < tangent.size(); ++e)  // symmetric in situ: elastic
      if (!std::isfinite(tangent[e])) throw InputError(m.p.name + ": stiffness is not finite");
    limit = 0.9 * 2 / fem::largest_frequency(m.matrices());
  }

  // Internal forces at u with the history of t; history, energies and (if wanted) the tangent that
  // belong to them.
  void evaluate(const std::vector<double>& u, std::vector<double>& force, bool want_tangent) {
    const int n = points.nodes, q = points.points, memory = model->history();
    std::fill(force.begin(), force.end(), 0.);
    if (want_tangent) std::fill(tangent.begin(), tangent.end(), 0.);
    new_history.resize(history.size());
    new_stored = new_plastic = 0;
    in.strain.resize(q), out.stress.resize(q), out.stored.resize(q), out.dissipated.resize(q);
    out.history.resize(static_cast<std::size_t>(q) * memory);
    out.want_tangent = want_tangent;
    out.tangent.resize(want_tangent ? q : 0);
    std::vector<int> ids(3 * n);
    std::vector<double> local(3 * n), f(3 * n), K, DB(18 * n);
    for (int c = 0; c < points.cells; ++c) {
      for (int a = 0; a < n; ++a)
        for (int d = 0; d < 3; ++d) {
          const int id = m.unknowns.of_node[m.body.cell_nodes[c * n + a]][d];
          ids[3 * a + d] = id;
          local[3 * a + d] = id < 0 ? 0. : u[id];
        }
      in.depth.assign(&points.depth[c * q], &points.depth[c * q] + q);
      const auto first = history.begin() + static_cast<std::ptrdiff_t>(c) * q * memory;
      in.history.assign(first, first + q * memory);
      for (int k = 0; k < q; ++k) {
        strain_matrix(points, c, k, B);
        for (int i = 0; i < 6; ++i) {
          double sum = 0;
          for (int j = 0; j < 3 * n; ++j) sum += B[3 * n * i + j] * local[j];
          in.strain[k][i] = sum;
        }
      }
      model->evaluate(in, out);
      std::copy(out.history.begin(), out.history.end(),
                new_history.begin() + static_cast<std::ptrdiff_t>(c) * q * memory);
      std::fill(f.begin(), f.end(), 0.);
      if (want_tangent) K.assign(9 * n * n, 0.);
      for (int k = 0; k < q; ++k) {
        const double w = points.weight[c * q + k];
        new_stored += w * out.stored[k];
        new_plastic += w * out.dissipated[k];
        strain_matrix(points, c, k, B);
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j < 3 * n; ++j) f[j] += w * B[3 * n * i + j] * out.stress[k][i];
        if (want_tangent) add_tangent(out.tangent[k], w, DB, K);
      }
      for (int j = 0; j < 3 * n; ++j) {
        if (ids[j] < 0) continue;
        force[ids[j]] += f[j];
        if (want_tangent)
          for (int l = 0; l < 3 * n; ++l)
            if (ids[l] >= 0)
              tangent[m.matrices().pattern.place(ids[j], ids[l])] += K[3 * n * j + l];
      }
    }
  }

  // K += w Bᵀ D B
  void add_tangent(const Tangent& D, double w, std::vector<double>& DB, std::vector<double>& K) {
    const int n3 = 3 * points.nodes;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < n3; ++j) {
        double sum = 0;
        for (int l = 0; l < 6; ++l) sum += D[6 * i + l] * B[n3 * l + j];
        DB[n3 * i + j] = w * sum;
      }
    for (int j = 0; j < n3; ++j)
      for (int i = 0; i < 6; ++i) {
        const double b = B[n3 * i + j];
        if (b == 0) continue;
        for (int l = 0; l < n3; ++l) K[n3 * j + l] += b * DB[n3 * i + l];
      }
  }

  void take_in_situ_off(std::vector<double>& force) const {
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= in_situ[i];
  }

  // The step's end becomes the state.
  void commit(const std::vector<double>& internal) {
    inner = internal;
    history = new_history;
    stored = new_stored;
    plastic += new_plastic;
  }

  double gravity() const { return -dot(in_situ, motion.u); }
  double kinetic() const {
    return product(m.matrices().pattern, m.matrices().mass, motion.v, motion.v) / 2;
  }
  double strain() const { return stored - stored_in_situ; }

  void advance_explicitly(const std::vector<double>& force) {
    Motion& s = motion;
    for (std::size_t i = 0; i < s.u.size(); ++i) s.u[i] += dt * (s.v[i] + 0.5 * dt * s.a[i]);
    evaluate(s.u, trial, false);
    take_in_situ_off(trial);
    commit(trial);
    for (std::size_t i = 0; i < s.u.size(); ++i) {
      const double a = (force[i] - inner[i]) / m.matrices().lumped[i];
      s.v[i] += 0.5 * dt * (s.a[i] + a);
      s.a[i] = a;
    }
  }

  void advance_implicitly(const std::vector<double>& force) {
    const auto alpha_m = scheme.alpha_m, alpha_f = scheme.alpha_f, beta = scheme.beta,
               gamma = scheme.gamma;
    Motion& s = motion;
    const std::size_t n = s.u.size();
    const double w = 1 - alpha_f;
    std::vector<double> a = s.a, u(n), r(n), da(n), values(tangent.size());
    const std::vector<double>& mass = m.matrices().lumped;
    for (int k = 0;; ++k) {
      double size = 0;
      for (std::size_t i = 0; i < n; ++i)
        u[i] = s.u[i] + dt * (s.v[i] + dt * ((0.5 - beta) * s.a[i] + beta * a[i]));
      evaluate(u, trial, true);
      take_in_situ_off(trial);
      for (std::size_t i = 0; i < n; ++i) {
        const double outer = w * force[i] + alpha_f * s.f[i],
                     inertia = mass[i] * ((1 - alpha_m) * a[i] + alpha_m * s.a[i]),
                     stress = w * trial[i] + alpha_f * inner[i];
        r[i] = outer - inertia - stress;
        size += outer * outer + inertia * inertia + stress * stress;
      }
      if (length(r) <= kConverged * std::sqrt(size) || size == 0) break;
      if (k == kMostIterations) not_converged(length(r) / std::sqrt(size));
      for (std::size_t e = 0; e < values.size(); ++e)
        values[e] = (1 - alpha_m) * m.matrices().mass[e] + w * beta * dt * dt * tangent[e];
      solve_unsymmetric(m.matrices().pattern, values, r, da, m.p.name.c_str());
      for (std::size_t i = 0; i < n; ++i) a[i] += da[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
      s.v[i] += dt * ((1 - gamma) * s.a[i] + gamma * a[i]);
      s.u[i] = u[i];
      s.a[i] = a[i];
    }
    commit(trial);
  }

  [[noreturn]] void not_converged(double residual) const {
    throw RunError(text(m.p.name, ": Newton's iteration did not converge in ", kMostIterations,
                        " steps (residual ", residual,
                        " of the forces): more load than the material bears, or too large a step"));
  }
};

NonlinearBody::NonlinearBody(ElasticBodyParameters p, std::shared_ptr<const StressModel> model) {
  parts_.reset(new Parts(std::move(p), std::move(model)));
  parts_->trial.assign(parts_->m.unknowns.count, 0.);
}

NonlinearBody::~NonlinearBody() = default;

const SurfaceMesh& NonlinearBody::surface() const { return parts_->m.surface.mesh; }
double NonlinearBody::explicit_limit() const { return parts_->limit; }
double NonlinearBody::mass() const { return parts_->m.mass(); }
double NonlinearBody::least_surface_mass() const { return parts_->m.least_surface_mass(); }
int NonlinearBody::unknowns() const { return parts_->m.unknowns.count; }
double NonlinearBody::largest_frequency() const { return 0.9 * 2 / parts_->limit; }

void NonlinearBody::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  parts_->dt = dt;
}
void NonlinearBody::set_load(int, double) { throw RunError("subgrade: it has no loads"); }
Vec NonlinearBody::load_displacement(int) const { throw RunError("subgrade: it has no loads"); }

void NonlinearBody::motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  const Parts& s = *parts_;
  displacement.resize(s.m.surface.node.size());
  velocity.resize(s.m.surface.node.size());
  for (std::size_t i = 0; i < s.m.surface.node.size(); ++i) {
    displacement[i] = s.m.at(s.motion.u, s.m.surface.node[i]);
    velocity[i] = s.m.at(s.motion.v, s.m.surface.node[i]);
  }
}

void NonlinearBody::predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  const Parts& s = *parts_;
  motion(displacement, velocity);
  for (std::size_t i = 0; i < s.m.surface.node.size(); ++i) {
    const Vec a = s.m.at(s.motion.a, s.m.surface.node[i]);
    for (int d = 0; d < 3; ++d) {
      displacement[i][d] += s.dt * (velocity[i][d] + 0.5 * s.dt * a[d]);
      velocity[i][d] += s.dt * a[d];
    }
  }
}

void NonlinearBody::advance(const std::vector<Vec>& forces) {
  Parts& s = *parts_;
  if (!(s.dt > 0)) throw RunError("structure: set_step() must come before advance()");
  s.m.check(forces);
  std::vector<double> force(s.m.unknowns.count, 0.);
  s.m.add_surface(forces, force);
  s.u_before = s.motion.u;
  if (s.dt <= s.limit)
    s.advance_explicitly(force);
  else
    s.advance_implicitly(force);
  s.motion.f = force;
  for (std::size_t i = 0; i < s.u_before.size(); ++i) s.u_before[i] = s.motion.u[i] - s.u_before[i];
  double work = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Vec du = s.m.at(s.u_before, s.m.surface.node[i]);
    for (int d = 0; d < 3; ++d) work += (s.surface_before[i][d] + forces[i][d]) * du[d];
    s.surface_before[i] = forces[i];
  }
  s.work += work / 2;
}

std::vector<double> NonlinearBody::solve_static(const std::vector<Vec>& forces, int load_steps) {
  Parts& s = *parts_;
  s.m.check(forces);
  const std::string free = s.m.free_motion();
  if (!free.empty())
    throw InputError(text(s.m.p.name, ": not held: it can still ", free,
                          ", so a static answer does not exist; add supports"));
  const std::size_t n = s.motion.u.size();
  std::vector<double> start(n, 0.), end(n, 0.), f(n), r(n), du(n), residuals;
  s.m.add_surface(s.surface_before, start);
  s.m.add_surface(forces, end);
  for (int step = 1; step <= load_steps; ++step) {
    const double share = static_cast<double>(step) / load_steps;
    for (std::size_t i = 0; i < n; ++i) f[i] = start[i] + share * (end[i] - start[i]);
    residuals.clear();
    double size = std::max(length(start), length(end));
    for (int k = 0;; ++k) {
      s.evaluate(s.motion.u, s.trial, true);
      s.take_in_situ_off(s.trial);
      for (std::size_t i = 0; i < n; ++i) r[i] = f[i] - s.trial[i];
      size = std::max(size, k == 0 ? length(s.trial) : 0);
      residuals.push_back(size > 0 ? length(r) / size : 0);
      if (residuals.back() <= kConverged) break;
      if (k == kMostIterations || !std::isfinite(residuals.back()))
        s.not_converged(residuals.back());
      solve_unsymmetric(s.m.matrices().pattern, s.tangent, r, du, s.m.p.name.c_str());
      for (std::size_t i = 0; i < n; ++i) s.motion.u[i] += du[i];
    }
    s.commit(s.trial);
  }
  std::fill(s.motion.v.begin(), s.motion.v.end(), 0.);
  std::fill(s.motion.a.begin(), s.motion.a.end(), 0.);
  s.motion.f = end;
  s.surface_before = forces;
  s.work = s.plastic = 0;
  s.at_start = s.strain() + s.gravity();
  return residuals;
}

StructureEnergy NonlinearBody::energy() const {
  const Parts& s = *parts_;
  StructureEnergy e;
  e.kinetic = s.kinetic();
  e.strain = s.strain();
  e.gravity = s.gravity();
  e.work_surface = s.work;
  e.dissipated_material = s.plastic;
  e.at_start = s.at_start;
  e.numerical = e.work_surface + e.at_start - e.kinetic - e.strain - e.gravity - s.plastic;
  return e;
}

void NonlinearBody::save(std::vector<double>& state) const {
  const Parts& s = *parts_;
  state = {s.work, s.plastic, s.at_start, s.stored};
  for (const auto* field :
       {&s.motion.u, &s.motion.v, &s.motion.a, &s.motion.f, &s.inner, &s.history})
    state.insert(state.end(), field->begin(), field->end());
  for (const Vec& f : s.surface_before) state.insert(state.end(), f.begin(), f.end());
}

void NonlinearBody::load(const std::vector<double>& state) {
  Parts& s = *parts_;
  const std::size_t expected =
      4 + 5 * s.motion.u.size() + s.history.size() + 3 * s.surface_before.size();
  if (state.size() != expected)
    throw InputError(text(s.m.p.name, ": the saved state has ", state.size(),
                          " numbers, this body needs ", expected, "; it belongs to another mesh"));
  s.work = state[0], s.plastic = state[1], s.at_start = state[2], s.stored = state[3];
  auto from = state.begin() + 4;
  for (auto* field : {&s.motion.u, &s.motion.v, &s.motion.a, &s.motion.f, &s.inner, &s.history}) {
    std::copy_n(from, field->size(), field->begin());
    from += static_cast<std::ptrdiff_t>(field->size());
  }
  for (Vec& f : s.surface_before) {
    std::copy_n(from, 3, f.begin());
    from += 3;
  }
}

Vec NonlinearBody::displacement_at(const Vec& point) const {
  const Parts& s = *parts_;
  return field_at(s.m.p, s.m.grid, s.m.everywhere(s.motion.u), point);
}

std::vector<Voigt> NonlinearBody::cell_stress() const {
  Parts& s = *parts_;
  std::vector<Voigt> mean(s.points.cells);
  const int n = s.points.nodes, q = s.points.points, memory = s.model->history();
  StressInputs in;
  StressOutputs out;
  in.strain.resize(q), out.stress.resize(q), out.stored.resize(q), out.dissipated.resize(q);
  out.history.resize(static_cast<std::size_t>(q) * memory);
  std::vector<double> B;
  for (int c = 0; c < s.points.cells; ++c) {
    in.depth.assign(&s.points.depth[c * q], &s.points.depth[c * q] + q);
    const auto first = s.history.begin() + static_cast<std::ptrdiff_t>(c) * q * memory;
    in.history.assign(first, first + q * memory);
    for (int k = 0; k < q; ++k) {
      strain_matrix(s.points, c, k, B);
      in.strain[k] = {};
      for (int i = 0; i < 6; ++i)
        for (int a = 0; a < n; ++a) {
          const Vec u = s.m.at(s.motion.u, s.m.body.cell_nodes[c * n + a]);
          for (int d = 0; d < 3; ++d) in.strain[k][i] += B[3 * n * i + 3 * a + d] * u[d];
        }
    }
    s.model->evaluate(in, out);
    double volume = 0;
    for (int k = 0; k < q; ++k) {
      const double w = s.points.weight[c * q + k];
      volume += w;
      for (int i = 0; i < 6; ++i) mean[c][i] += w * out.stress[k][i];
    }
    for (double& component : mean[c]) component /= volume;
  }
  return mean;
}

void NonlinearBody::write_vtu(const std::string& file) const {
  const Parts& s = *parts_;
  write_fields(file, s.m.p, s.m.grid, s.m.body, s.m.everywhere(s.motion.u),
               s.m.everywhere(s.motion.v), cell_stress());
}

}  // namespace trackbed::fem
