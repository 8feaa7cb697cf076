#include "fem/nonlinear_body.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "fem/body_model.h"
#include "fem/frequencies.h"
#include "fem/history_motion.h"
#include "fem/output.h"
#include "fem/text.h"
#include "fem/unsymmetric_solver.h"

namespace trackbed::fem {
namespace {

HistoryCells all_cells(const BodyModel& m, std::shared_ptr<const StressModel> model) {
  std::vector<int> cells(m.grid.cells.n_active_cells());
  std::iota(cells.begin(), cells.end(), 0);
  std::vector<int> place = cell_unknowns(m.body, m.unknowns, cells);
  std::vector<char> own(cells.size(), 1);
  return {m.grid, m.p.order, std::move(model), std::move(cells), std::move(place), std::move(own)};
}

}  // namespace

struct NonlinearBody::Parts final : HistoryEquations {
  BodyModel m;
  HistoryCells cells;
  HistoryMotion motion;
  std::vector<double> tangent;  // by the pattern of the matrices

  std::vector<Vec> surface_before;
  double work = 0, at_start = 0;
  std::vector<double> force, u_before;

  Parts(ElasticBodyParameters given, std::shared_ptr<const StressModel> model)
      : m(history_parameters(std::move(given), model->density())),
        cells(all_cells(m, std::move(model))),
        motion(m.p.name, m.p.newmark ? newmark() : generalised_alpha(m.p.rho_inf),
               m.matrices().lumped, cells, *this) {
    surface_before.assign(m.surface.node.size(), Vec{});
    force.assign(m.unknowns.count, 0.);
    tangent.assign(m.matrices().pattern.column.size(), 0.);
    motion.start();
    for (const double e : tangent)
      if (!std::isfinite(e)) throw InputError(m.p.name + ": stiffness is not finite");
    m.assembled.matrices.stiffness = tangent;
    motion.set_largest_frequency(fem::largest_frequency(m.matrices()));
  }

  void evaluate(const std::vector<double>& u, bool want_tangent,
                std::vector<double>& inner_force) override {
    std::fill(inner_force.begin(), inner_force.end(), 0.);
    if (!want_tangent) return cells.evaluate(u, inner_force, nullptr);
    std::fill(tangent.begin(), tangent.end(), 0.);
    const int n3 = 3 * m.body.nodes_per_cell;
    cells.evaluate(u, inner_force, [&](const int* id, const std::vector<double>& K) {
      for (int j = 0; j < n3; ++j)
        for (int l = 0; l < n3; ++l)
          if (id[j] >= 0 && id[l] >= 0)
            tangent[m.matrices().pattern.place(id[j], id[l])] += K[n3 * j + l];
    });
  }

  void solve(double mass_share, double tangent_share, const std::vector<double>& b,
             std::vector<double>& x) override {
    const Pattern& pattern = m.matrices().pattern;
    for (double& e : tangent) e *= tangent_share;
    for (int i = 0; i < pattern.rows(); ++i)
      tangent[pattern.place(i, i)] += mass_share * m.matrices().lumped[i];
    solve_unsymmetric(pattern, tangent, b, x, m.p.name, m.p.solver, m.matrices().rigid);
  }
};

NonlinearBody::NonlinearBody(ElasticBodyParameters p, std::shared_ptr<const StressModel> model) {
  parts_ = std::make_unique<Parts>(std::move(p), std::move(model));
}

NonlinearBody::~NonlinearBody() = default;

const SurfaceMesh& NonlinearBody::surface() const { return parts_->m.surface.mesh; }
double NonlinearBody::explicit_limit() const { return parts_->motion.explicit_limit(); }
double NonlinearBody::mass() const { return parts_->m.mass(); }
double NonlinearBody::least_surface_mass() const { return parts_->m.least_surface_mass(); }
int NonlinearBody::unknowns() const { return parts_->m.unknowns.count; }
double NonlinearBody::largest_frequency() const { return 0.9 * 2 / explicit_limit(); }
double NonlinearBody::contact_bound(const std::vector<NodeSpring>& springs) const {
  const double own = parts_->motion.is_explicit() ? largest_frequency() : 0;
  return Structure::contact_bound(springs) + own * own;
}

void NonlinearBody::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  parts_->motion.set_step(dt);
}
void NonlinearBody::set_load(int, double) { throw RunError("subgrade: it has no loads"); }
Vec NonlinearBody::load_displacement(int) const { throw RunError("subgrade: it has no loads"); }

void NonlinearBody::motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  const Parts& s = *parts_;
  displacement.resize(s.m.surface.node.size());
  velocity.resize(s.m.surface.node.size());
  for (std::size_t i = 0; i < s.m.surface.node.size(); ++i) {
    displacement[i] = s.m.at(s.motion.now.u, s.m.surface.node[i]);
    velocity[i] = s.m.at(s.motion.now.v, s.m.surface.node[i]);
  }
}

void NonlinearBody::predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  const Parts& s = *parts_;
  displacement.assign(s.m.surface.node.size(), Vec{});
  velocity.assign(s.m.surface.node.size(), Vec{});
  for (std::size_t i = 0; i < s.m.surface.node.size(); ++i)
    for (int d = 0; d < 3; ++d)
      if (const int id = s.m.unknowns.of_node[s.m.surface.node[i]][d]; id >= 0) {
        displacement[i][d] = s.motion.place_ahead(id);
        velocity[i][d] = s.motion.velocity_ahead(id);
      }
}

void NonlinearBody::advance(const std::vector<Vec>& forces) {
  Parts& s = *parts_;
  if (!(s.motion.step() > 0)) throw RunError("structure: set_step() must come before advance()");
  s.m.check(forces);
  std::fill(s.force.begin(), s.force.end(), 0.);
  s.m.add_surface(forces, s.force);
  s.u_before = s.motion.now.u;
  s.motion.advance(s.force);
  for (std::size_t i = 0; i < s.u_before.size(); ++i)
    s.u_before[i] = s.motion.now.u[i] - s.u_before[i];
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
  std::vector<double> start(s.force.size(), 0.), end(s.force.size(), 0.);
  s.m.add_surface(s.surface_before, start);
  s.m.add_surface(forces, end);
  const std::vector<double> residuals = s.motion.settle(start, end, load_steps);
  s.surface_before = forces;
  s.work = 0;
  s.at_start = s.motion.strain() + s.motion.gravity();
  return residuals;
}

StructureEnergy NonlinearBody::energy() const {
  const Parts& s = *parts_;
  StructureEnergy e;
  e.kinetic = s.motion.kinetic();
  e.strain = s.motion.strain();
  e.gravity = s.motion.gravity();
  e.work_surface = s.work;
  e.dissipated_material = s.motion.plastic;
  e.at_start = s.at_start;
  e.numerical =
      e.work_surface + e.at_start - e.kinetic - e.strain - e.gravity - e.dissipated_material;
  return e;
}

void NonlinearBody::save(std::vector<double>& state) const {
  const Parts& s = *parts_;
  const Motion& now = s.motion.now;
  state = {s.work, s.motion.plastic, s.at_start, s.motion.stored};
  for (const auto* field : {&now.u, &now.v, &now.a, &now.f, &s.motion.inner, &s.cells.history()})
    state.insert(state.end(), field->begin(), field->end());
  for (const Vec& f : s.surface_before) state.insert(state.end(), f.begin(), f.end());
}

void NonlinearBody::load(const std::vector<double>& state) {
  Parts& s = *parts_;
  Motion& now = s.motion.now;
  const std::size_t expected =
      4 + 5 * now.u.size() + s.cells.history().size() + 3 * s.surface_before.size();
  if (state.size() != expected)
    throw InputError(text(s.m.p.name, ": the saved state has ", state.size(),
                          " numbers, this body needs ", expected,
                          "; it belongs to another mesh or was written under mpirun"));
  s.work = state[0], s.motion.plastic = state[1], s.at_start = state[2];
  s.motion.stored = state[3];
  auto from = state.begin() + 4;
  for (auto* field : {&now.u, &now.v, &now.a, &now.f, &s.motion.inner, &s.cells.history()}) {
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
  return field_at(s.m.p, s.m.grid, s.m.everywhere(s.motion.now.u), point);
}

std::vector<Voigt> NonlinearBody::cell_stress() const {
  return parts_->cells.mean_stress(parts_->motion.now.u);
}

void NonlinearBody::write_vtu(const std::string& file) const {
  const Parts& s = *parts_;
  write_fields(file, s.m.p, s.m.grid, s.m.body, s.m.everywhere(s.motion.now.u),
               s.m.everywhere(s.motion.now.v), cell_stress());
}

}  // namespace trackbed::fem
