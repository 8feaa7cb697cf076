#include "fem/modal_structure.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/contact_bound.h"
#include "fem/sparse.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

constexpr double kStatic = 1;  // ωΔt beyond which a mode follows statically
constexpr int kMostModes = 128;

// Of a symmetric, positive semidefinite n x n matrix, from above: (tr A^64)^(1/64), six squarings.
double largest_eigenvalue(std::vector<double> a, int n) {
  const auto trace = [&] {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += a[i * n + i];
    return sum;
  };
  const double size = trace();
  if (!(size > 0)) return 0;
  for (double& x : a) x /= size;
  double log_scale = 0;  // A^(2^k) = size^(2^k) exp(log_scale) a
  std::vector<double> square(a.size());
  for (int k = 0; k < 6; ++k) {
    std::fill(square.begin(), square.end(), 0.);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double f = a[i * n + j];
        for (int l = 0; l < n; ++l) square[i * n + l] += f * a[j * n + l];
      }
    a.swap(square);
    const double t = trace();
    for (double& x : a) x /= t;
    log_scale = 2 * log_scale + std::log(t);
  }
  return size * std::exp(log_scale / 64);
}

}  // namespace

ModalStructure::ModalStructure(ModalModel model) : m_(std::move(model)) {
  const std::size_t n = m_.omega.size();
  if (n == 0) throw InputError(m_.name + ": no modes; nothing can move");
  if (m_.shape.size() != 3 * m_.surface.nodes.size() * n ||
      (!m_.gravity.empty() && m_.gravity.size() != n))
    throw InputError(m_.name + ": the modes' shapes do not fit the surface");
  for (auto* field :
       {&q_, &v_, &force_, &surface_force_, &next_q_, &next_v_, &next_force_, &next_surface_})
    field->assign(n, 0.);
  load_.assign(m_.loads.size(), 0.);
  if (m_.gravity.empty()) return;
  if (m_.start_in_equilibrium)
    solve_static();
  else
    outer_force(force_);
}

void ModalStructure::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  dt_ = dt;
  step_.clear();
  for (const double omega : m_.omega) {
    Step s{};
    const double w = std::min(omega, kStatic / dt);
    const double delta = 0.5 * (m_.damping_mass + m_.damping_stiffness * w * w);
    s.mass = w > 0 ? omega / w * (omega / w) : 1;
    if (w > 0) {
      const double r2 = w * w - delta * delta, r = std::sqrt(std::abs(r2)),
                   decay = std::exp(-delta * dt);
      const double cosine = r2 > 0 ? std::cos(r * dt) : std::cosh(r * dt);
      const double sine = r * dt < 1e-9 ? dt : (r2 > 0 ? std::sin(r * dt) : std::sinh(r * dt)) / r;
      s.a = decay * (cosine + delta * sine);
      s.b = decay * sine;
      s.c = -w * w * s.b;
      s.d = decay * (cosine - delta * sine);
      // 1 − cos by the half angle: no digits lost where ωΔt is small.
      const double half = std::sin(0.5 * w * dt);
      s.e = delta > 0 ? (1 - s.a) / (w * w) : 2 * half * half / (w * w);
      s.b1 = std::tan(0.5 * w * dt) / w;
      s.b0 = s.b - s.b1;
    } else {
      const double decay = delta > 0 ? -std::expm1(-2 * delta * dt) / (2 * delta) : dt;
      s.a = 1, s.b = decay, s.c = 0, s.d = std::exp(-2 * delta * dt);
      s.e = delta > 0 ? (dt - decay) / (2 * delta) : 0.5 * dt * dt;
      s.b1 = 0.5 * dt;
      s.b0 = s.b - s.b1;
    }
    s.e /= s.mass, s.b0 /= s.mass, s.b1 /= s.mass;
    step_.push_back(s);
  }
}

void ModalStructure::place(const std::vector<double>& q, std::vector<Vec>& u) const {
  u.resize(m_.surface.nodes.size());
  modal_place(m_.shape.data(), static_cast<int>(u.size()), modes(), q.data(), u.data()->data());
}

void ModalStructure::predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  if (step_.empty()) throw RunError("structure: set_step() must come before predict()");
  for (int i = 0; i < modes(); ++i) {
    const Step& s = step_[i];
    next_q_[i] = s.a * q_[i] + s.b * v_[i] + s.e * force_[i];
    next_v_[i] = s.c * q_[i] + s.d * v_[i] + (s.b0 + s.b1) * force_[i];
  }
  place(next_q_, displacement);
  place(next_v_, velocity);
}

void ModalStructure::motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  place(q_, displacement);
  place(v_, velocity);
}

void ModalStructure::outer_force(std::vector<double>& p) const {
  const int n = modes();
  if (m_.gravity.empty())
    std::fill(p.begin(), p.end(), 0.);
  else
    p = m_.gravity;
  for (std::size_t l = 0; l < load_.size(); ++l) {
    if (load_[l] == 0) continue;
    const ModalLoad& load = m_.loads[l];
    for (int d = 0; d < 3; ++d)
      for (int i = 0; i < n; ++i) p[i] += load_[l] * load.direction[d] * load.shape[d * n + i];
  }
}

void ModalStructure::add_surface(const std::vector<Vec>& forces, std::vector<double>& p) const {
  const int n = modes();
  if (forces.size() != m_.surface.nodes.size())
    throw RunError(text(m_.name, ": ", forces.size(), " surface forces for ",
                        m_.surface.nodes.size(), " nodes"));
  std::fill(p.begin(), p.end(), 0.);
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (int d = 0; d < 3; ++d) {
      const double f = forces[i][d];
      if (f == 0) continue;  // most nodes touch nothing
      if (!std::isfinite(f))
        throw RunError(text(m_.name, ": the contact force on surface node ", i,
                            " is not finite; the time step is probably too large"));
      const double* row = &m_.shape[(3 * i + d) * n];
      for (int k = 0; k < n; ++k) p[k] += f * row[k];
    }
}

void ModalStructure::advance(const std::vector<Vec>& forces) {
  if (step_.empty()) throw RunError("structure: set_step() must come before advance()");
  add_surface(forces, next_surface_);
  outer_force(next_force_);
  double work_surface = 0, work = 0, damping = 0;
  for (int i = 0; i < modes(); ++i) {
    const Step& s = step_[i];
    const double p = next_force_[i] + next_surface_[i];
    const double q = s.a * q_[i] + s.b * v_[i] + s.e * force_[i];
    const double v = s.c * q_[i] + s.d * v_[i] + s.b0 * force_[i] + s.b1 * p;
    const double dq = q - q_[i];
    const double weight = m_.gravity.empty() ? 0 : m_.gravity[i];
    work_surface += 0.5 * (surface_force_[i] + next_surface_[i]) * dq;
    work += (0.5 * (force_[i] + p - surface_force_[i] - next_surface_[i]) - weight) * dq;
    const double w = std::min(m_.omega[i], kStatic / dt_);
    damping += (m_.damping_mass + m_.damping_stiffness * w * w) * s.mass * 0.5 *
               (v_[i] * v_[i] + v * v) * dt_;
    q_[i] = q, v_[i] = v;
    force_[i] = p, surface_force_[i] = next_surface_[i];
  }
  work_surface_ += work_surface;
  work_loads_ += work;
  damping_ += damping;
}

void ModalStructure::set_load(int load, double newton) {
  if (!std::isfinite(newton))
    throw RunError(text(m_.name, ": load '", m_.loads.at(load).name, "' is not finite"));
  load_.at(load) = newton;
}

Vec ModalStructure::load_displacement(int load) const {
  const int n = modes();
  Vec u{};
  for (int d = 0; d < 3; ++d)
    for (int i = 0; i < n; ++i) u[d] += m_.loads.at(load).shape[d * n + i] * q_[i];
  return u;
}

double ModalStructure::gauge(int k) const { return dot(m_.gauges.at(k).shape, q_); }

double ModalStructure::largest_frequency() const {
  return *std::max_element(m_.omega.begin(), m_.omega.end());
}

double ModalStructure::contact_bound(const std::vector<NodeSpring>& springs) const {
  const double lambda = modes() > kMostModes ? by_iterations(springs) : by_powers(springs);
  const double own = largest_frequency(), cosine = std::cos(0.5 * kStatic);
  return std::min(lambda + own * own, lambda / (cosine * cosine));
}

// Largest eigenvalue of Φᵀ S Φ, from above.
double ModalStructure::by_powers(const std::vector<NodeSpring>& springs) const {
  const int n = modes();
  std::vector<double> sum(n * n, 0.);
  std::vector<double> pushed(n);
  for (const NodeSpring& s : springs)
    for (int d = 0; d < 3; ++d) {
      const double* shape = &m_.shape[3 * s.node * n];
      for (int k = 0; k < n; ++k)
        pushed[k] = s.stiffness[d][0] * shape[k] + s.stiffness[d][1] * shape[n + k] +
                    s.stiffness[d][2] * shape[2 * n + k];
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) sum[i * n + j] += shape[d * n + i] * pushed[j];
    }
  return largest_eigenvalue(std::move(sum), n);
}

double ModalStructure::by_iterations(const std::vector<NodeSpring>& springs) const {
  const int n = modes(), nodes = static_cast<int>(m_.surface.nodes.size());
  std::vector<double> q(n);
  return largest_contact_eigenvalue(
      springs, nodes, [&](const std::vector<Vec>& forces, std::vector<Vec>& accelerations) {
        std::fill(q.begin(), q.end(), 0.);  // Φᵀ f
        for (int i = 0; i < 3 * nodes; ++i)
          for (int k = 0; k < n; ++k) q[k] += m_.shape[i * n + k] * forces[i / 3][i % 3];
        for (int i = 0; i < 3 * nodes; ++i) {
          double a = 0;
          for (int k = 0; k < n; ++k) a += m_.shape[i * n + k] * q[k];
          accelerations[i / 3][i % 3] = a;
        }
      });
}

double ModalStructure::kinetic() const {
  double sum = 0;
  for (int i = 0; i < modes(); ++i) sum += (step_.empty() ? 1 : step_[i].mass) * v_[i] * v_[i];
  return sum / 2;
}

double ModalStructure::strain() const {
  double sum = 0;
  for (int i = 0; i < modes(); ++i) sum += m_.omega[i] * m_.omega[i] * q_[i] * q_[i];
  return sum / 2;
}

double ModalStructure::gravity_potential() const {
  return m_.gravity.empty() ? 0 : -dot(m_.gravity, q_);
}

void ModalStructure::start_ledger() {
  work_loads_ = work_surface_ = damping_ = 0;
  at_start_ = kinetic() + strain() + gravity_potential();
}

StructureEnergy ModalStructure::energy() const {
  StructureEnergy e;
  e.kinetic = kinetic();
  e.strain = strain();
  e.gravity = gravity_potential();
  e.work_loads = work_loads_;
  e.work_surface = work_surface_;
  e.dissipated_damping = damping_;
  e.at_start = at_start_;
  e.numerical = e.work_loads + e.work_surface + e.at_start - e.kinetic - e.strain - e.gravity -
                e.dissipated_damping;
  return e;
}

void ModalStructure::save(std::vector<double>& state) const {
  state = {work_loads_, work_surface_, damping_, at_start_};
  for (const auto* field : {&q_, &v_, &force_, &surface_force_, &load_})
    state.insert(state.end(), field->begin(), field->end());
}

void ModalStructure::load(const std::vector<double>& state) {
  const std::size_t expected = 4 + 4 * q_.size() + load_.size();
  if (state.size() != expected)
    throw InputError(text(m_.name, ": the saved state has ", state.size(),
                          " numbers, this body needs ", expected,
                          "; it belongs to another mesh or number of modes"));
  work_loads_ = state[0], work_surface_ = state[1], damping_ = state[2], at_start_ = state[3];
  auto from = state.begin() + 4;
  for (auto* field : {&q_, &v_, &force_, &surface_force_, &load_}) {
    std::copy_n(from, field->size(), field->begin());
    from += static_cast<std::ptrdiff_t>(field->size());
  }
}

void ModalStructure::write_vtu(const std::string& file) const {
  if (m_.write) m_.write(file, q_, v_);
}

void ModalStructure::solve_static(const std::vector<Vec>& forces) {
  outer_force(force_);
  std::fill(surface_force_.begin(), surface_force_.end(), 0.);
  if (!forces.empty()) add_surface(forces, surface_force_);
  double largest = 0;
  for (int i = 0; i < modes(); ++i) {
    force_[i] += surface_force_[i];
    largest = std::max(largest, std::abs(force_[i]));
  }
  for (int i = 0; i < modes(); ++i) {
    if (m_.omega[i] == 0 && std::abs(force_[i]) > 1e-9 * largest)
      throw InputError(m_.name +
                       ": not held: a load acts along a rigid motion, so a static answer does not "
                       "exist; add supports or a bed");
    q_[i] = m_.omega[i] > 0 ? force_[i] / (m_.omega[i] * m_.omega[i]) : 0;
    v_[i] = 0;
  }
  start_ledger();
}

void ModalStructure::set_modal_velocity(const std::vector<double>& v) {
  v_ = v;
  outer_force(force_);
  std::fill(surface_force_.begin(), surface_force_.end(), 0.);
  start_ledger();
}

}  // namespace trackbed::fem
