#include "fem/distributed_body.h"

#include <petscksp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "base/error.h"
#include "fem/distributed_matrices.h"
#include "fem/load_patch.h"
#include "fem/output.h"
#include "fem/session.h"
#include "fem/surface.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// What rank 0 asks the others to take part in.
enum Task { kRelease, kBuild, kSetStep, kGather, kAdvance, kEnergy, kMean, kScatter, kDestroy };
struct Order {
  double task, body, value, extra;
};

// By number: the same on all ranks, for all build the same bodies in the same order.
std::map<int, DistributedBody*>& bodies() {
  static std::map<int, DistributedBody*> all;
  return all;
}
int next_number = 0;
bool together = false;  // a BuildingTogether lives
bool served = true;     // by the other ranks, until they are released

void give(double task, double body = 0, double value = 0, double extra = 0) {
  Order order{task, body, value, extra};
  MPI_Bcast(&order, 4, MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

bool first_rank() { return rank() == 0; }

double inner(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

const ElasticBodyParameters& checked(const ElasticBodyParameters& p) {
  const auto refuse = [&](const char* what) {
    throw InputError(
        text(p.name, ": ", what, " cannot be shared by several ranks; run without mpirun"));
  };
  if (!p.beds.empty()) refuse("a bed or an absorbing boundary");
  for (const Material& m : p.materials)
    if (m.rayleigh_mass > 0 || m.rayleigh_stiffness > 0) refuse("Rayleigh damping");
  if (p.scheme == TimeScheme::central_difference || p.scheme == TimeScheme::zhai)
    refuse("an explicit time scheme by name");
  return p;
}

}  // namespace

// All functions here are called by all ranks together, unless they say otherwise.
struct DistributedBody::Parts {
  DistributedMatrices m;
  ContactSurface surface;
  std::vector<LoadPatch> patches;
  Scheme scheme;
  int number;  // among the bodies

  DistributedVector u, v, a, f, force, work, rhs, surface_force, surface_before;
  std::vector<DistributedVector> load_weight;  // of a positive force
  SurfaceExchange exchange;
  std::unique_ptr<DistributedSolver> solver;
  std::vector<double> load, load_before;
  double dt = 0, limit = 0, work_loads = 0, work_surface = 0, at_start = 0;
  bool goes_explicitly = false;

  explicit Parts(ElasticBodyParameters p)
      : m(std::move(p)),
        surface(contact_surface(m.body, m.unknowns, m.p.name, m.p.contact)),
        scheme(m.p.newmark ? newmark() : generalised_alpha(m.p.rho_inf)),
        number(next_number++),
        exchange(m, surface.node) {
    for (auto* x : {&u, &v, &a, &f, &force, &work, &rhs, &surface_force, &surface_before})
      x->reinit(m);
    for (const Load& l : m.p.loads) {
      patches.push_back(load_patch(m.body, m.p.name, l));
      load_weight.emplace_back();
      load_weight.back().reinit(m);
      for (const auto& [node, weight] : patches.back().weights)
        for (int d = 0; d < 3; ++d)
          load_weight.back().add(m, node, d, weight * patches.back().direction[d]);
    }
    load.assign(patches.size(), 0.);
    load_before = load;
    if (is_static() && !m.held)
      throw InputError(m.p.name + ": not held, so that no static answer exists; add supports");
    if (m.lumped && !is_static()) limit = 0.9 * 2 / m.largest_frequency();
    if (inner(m.p.gravity, m.p.gravity) > 0) {
      outer_force(f);
      if (m.p.start_in_equilibrium && m.held)
        DistributedSolver(m, m.stiffness, m.p.solver).solve(f, u);
      else if (!is_static())
        m.solve_mass(f, a);
    }
    start_ledger();
  }

  void outer_force(DistributedVector& to) {
    to.copy(m.gravity);
    for (std::size_t l = 0; l < load.size(); ++l) to.add_scaled(load[l], load_weight[l]);
  }

  bool is_static() const { return m.p.scheme == TimeScheme::quasi_static; }
  double kinetic() { return is_static() ? 0 : m.mass_product(v, work) / 2; }
  double strain() { return m.stiffness_product(u, work) / 2; }
  double gravity() { return -m.gravity.dot(u); }
  void start_ledger() {
    work_loads = work_surface = 0;
    at_start = kinetic() + strain() + gravity();
  }

  void set_step(double step) {
    dt = step;
    goes_explicitly = dt <= limit;
    if (is_static()) {  // one factor for all steps
      if (!solver) solver = std::make_unique<DistributedSolver>(m, m.stiffness, m.p.solver);
      return;
    }
    solver.reset();
    if (goes_explicitly) return;
    const double k = (1 - scheme.alpha_f) * scheme.beta * dt * dt;
    solver = std::make_unique<DistributedSolver>(m, 1 - scheme.alpha_m, k, m.p.solver);
  }

  // With the forces on the surface in `surface_force` and the loads set.
  void advance() {
    outer_force(force);
    force.add_scaled(1, surface_force);
    work.copy(u);
    const DistributedVector before = work;
    if (is_static())
      advance_statically();
    else if (goes_explicitly)
      advance_explicitly();
    else
      advance_implicitly();
    work.copy(u);
    work.add_scaled(-1, before);
    surface_before.add_scaled(1, surface_force);
    work_surface += surface_before.dot(work) / 2;
    surface_before.copy(surface_force);
    for (std::size_t l = 0; l < load.size(); ++l) {
      const double sum = load[l] + load_before[l];
      if (sum != 0) work_loads += sum / 2 * load_weight[l].dot(work);
      load_before[l] = load[l];
    }
    f.copy(force);
  }

  void advance_statically() {
    v.copy(u);
    solver->solve(force, u);
    v.scale(-1);
    v.add_scaled(1, u);
    v.scale(1 / dt);
  }

  void advance_explicitly() {
    u.add_scaled(dt, v);
    u.add_scaled(0.5 * dt * dt, a);
    m.multiply_stiffness(u, rhs);
    v.add_scaled(0.5 * dt, a);
    a.copy(force);
    a.add_scaled(-1, rhs);
    m.divide_by_mass(a);
    v.add_scaled(0.5 * dt, a);
  }

  void advance_implicitly() {
    const double alpha_m = scheme.alpha_m, alpha_f = scheme.alpha_f, beta = scheme.beta,
                 gamma = scheme.gamma, w = 1 - alpha_f;
    // rhs = w f₊ + α_f f − α_m M a − K (u + w Δt (v + Δt (½−β) a))
    work.copy(u);
    work.add_scaled(w * dt, v);
    work.add_scaled(w * dt * dt * (0.5 - beta), a);
    m.multiply_stiffness(work, rhs);
    rhs.scale(-1);
    rhs.add_scaled(w, force);
    rhs.add_scaled(alpha_f, f);
    m.multiply_mass(a, work);
    rhs.add_scaled(-alpha_m, work);
    work.copy(a);  // first guess
    solver->solve(rhs, work);
    u.add_scaled(dt, v);
    u.add_scaled(dt * dt * (0.5 - beta), a);
    u.add_scaled(dt * dt * beta, work);
    v.add_scaled(dt * (1 - gamma), a);
    v.add_scaled(dt * gamma, work);
    a.copy(work);
  }

  // Surface values of u + h v + ½ h² a and v + h a (h = 0: of now), on rank 0.
  void gather(double h, std::vector<Vec>& displacement, std::vector<Vec>& velocity) {
    work.copy(u);
    work.add_scaled(h, v);
    work.add_scaled(0.5 * h * h, a);
    exchange.gather(work, displacement);
    work.copy(v);
    work.add_scaled(h, a);
    exchange.gather(work, velocity);
  }

  StructureEnergy energy() {
    StructureEnergy e;
    e.kinetic = kinetic(), e.strain = strain(), e.gravity = gravity();
    e.work_loads = work_loads, e.work_surface = work_surface;
    e.at_start = at_start;
    e.numerical = e.work_loads + e.work_surface + e.at_start - e.kinetic - e.strain - e.gravity;
    return e;
  }

  std::array<DistributedVector*, 5> state() { return {&u, &v, &a, &f, &surface_before}; }

  // Rank 0's share of an order.
  void order(double task, double value = 0, double extra = 0) const {
    if (first_rank()) give(task, number, value, extra);
  }
};

DistributedBody::DistributedBody(ElasticBodyParameters p) : parts_(nullptr) {
  start_session();
  checked(p);
  parts_ = std::make_unique<Parts>(std::move(p));
  bodies()[parts_->number] = this;
}

DistributedBody::~DistributedBody() {
  // PETSc's objects go on all ranks together.
  if (served && ranks() > 1) parts_->order(kDestroy);
  bodies().erase(parts_->number);
}

const SurfaceMesh& DistributedBody::surface() const { return parts_->surface.mesh; }
double DistributedBody::explicit_limit() const { return parts_->limit; }
int DistributedBody::loads() const { return static_cast<int>(parts_->patches.size()); }
double DistributedBody::mass() const { return parts_->m.mass(); }
double DistributedBody::least_surface_mass() const {
  return parts_->is_static() ? std::numeric_limits<double>::infinity()
                             : parts_->m.least_mass(parts_->surface.node);
}
double DistributedBody::largest_frequency() const { return parts_->m.omega; }
double DistributedBody::contact_bound(const std::vector<NodeSpring>& springs) const {
  const double own = parts_->goes_explicitly ? 0.9 * 2 / parts_->limit : 0;
  return Structure::contact_bound(springs) + own * own;
}
int DistributedBody::unknowns() const { return parts_->m.unknowns.count; }
int DistributedBody::solver_iterations() const {
  return parts_->solver ? parts_->solver->iterations() : 0;
}
std::vector<int> DistributedBody::rank_unknowns() const { return parts_->m.rows_of_rank; }

void DistributedBody::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  if (dt == parts_->dt) return;
  parts_->order(kSetStep, dt);
  parts_->set_step(dt);
}

void DistributedBody::predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  parts_->order(kGather, parts_->dt);
  parts_->gather(parts_->dt, displacement, velocity);
}

void DistributedBody::motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  parts_->order(kGather, 0);
  parts_->gather(0, displacement, velocity);
}

void DistributedBody::set_load(int load, double newton) {
  if (!std::isfinite(newton))
    throw RunError(
        text(parts_->m.p.name, ": load '", parts_->m.p.loads.at(load).name, "' is not finite"));
  parts_->load.at(load) = newton;
}

void DistributedBody::advance(const std::vector<Vec>& forces) {
  Parts& s = *parts_;
  if (!(s.dt > 0)) throw RunError("structure: set_step() must come before advance()");
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (!std::isfinite(inner(forces[i], forces[i])))
      throw RunError(text(s.m.p.name, ": the contact force on surface node ", i,
                          " is not finite; the time step is probably too large"));
  s.order(kAdvance);
  MPI_Bcast(s.load.data(), static_cast<int>(s.load.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  s.exchange.scatter(forces, s.surface_force);
  s.advance();
}

Vec DistributedBody::load_displacement(int load) const {
  Parts& s = *parts_;
  s.order(kMean, load);
  Vec mean{};
  for (const auto& [node, weight] : s.patches.at(load).weights)
    for (int d = 0; d < 3; ++d) mean[d] += weight * s.u.own(s.m, node, d);
  MPI_Allreduce(MPI_IN_PLACE, mean.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return mean;
}

StructureEnergy DistributedBody::energy() const {
  parts_->order(kEnergy);
  return parts_->energy();
}

void DistributedBody::save(std::vector<double>& state) const {
  Parts& s = *parts_;
  state.clear();
  int k = 0;
  for (DistributedVector* x : s.state()) {
    s.order(kScatter, k++, 0);
    const std::vector<double> all = x->everywhere(s.m);
    state.insert(state.end(), all.begin(), all.end());
  }
  state.insert(state.end(), s.load.begin(), s.load.end());
  state.insert(state.end(), s.load_before.begin(), s.load_before.end());
  state.insert(state.end(), {s.work_loads, s.work_surface, s.at_start});
}

void DistributedBody::load(const std::vector<double>& state) {
  Parts& s = *parts_;
  const std::size_t n = s.m.unknowns.count, loads = s.load.size();
  if (state.size() != 5 * n + 2 * loads + 3)
    throw InputError(text(s.m.p.name, ": the saved state has ", state.size(),
                          " numbers, this body needs ", 5 * n + 2 * loads + 3,
                          "; it belongs to another mesh or was written without mpirun"));
  s.order(kScatter, 0, 1);
  std::vector<double> copy = state;
  MPI_Bcast(copy.data(), static_cast<int>(copy.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  auto from = copy.begin();
  for (DistributedVector* x : s.state()) {
    x->take(s.m, std::vector<double>(from, from + static_cast<std::ptrdiff_t>(n)));
    from += static_cast<std::ptrdiff_t>(n);
  }
  for (auto* l : {&s.load, &s.load_before}) {
    std::copy_n(from, loads, l->begin());
    from += static_cast<std::ptrdiff_t>(loads);
  }
  s.work_loads = from[0], s.work_surface = from[1], s.at_start = from[2];
}

void DistributedBody::write_vtu(const std::string& file) const {
  Parts& s = *parts_;
  s.order(kScatter, 0, 0);
  const auto u = s.u.everywhere(s.m);
  s.order(kScatter, 1, 0);
  const auto v = s.v.everywhere(s.m);
  if (first_rank()) write_fields(file, s.m.p, s.m.grid, s.m.body, s.m.at_nodes(u), s.m.at_nodes(v));
}

BuildingTogether::BuildingTogether() { together = true; }
BuildingTogether::~BuildingTogether() { together = false; }

std::unique_ptr<Structure> make_elastic_body(ElasticBodyParameters p) {
  if (together && ranks() > 1) return std::make_unique<DistributedBody>(std::move(p));
  return std::make_unique<ElasticBody>(std::move(p));
}

void ask_to_build(int what, double value) {
  if (ranks() > 1 && first_rank()) give(kBuild, 0, what, value);
}

void release_ranks() {
  if (ranks() > 1 && first_rank() && served) give(kRelease);
  served = false;
}

void serve(const BuildTogether& build) {
  std::vector<std::unique_ptr<Structure>> owned;
  std::vector<Vec> unused, none;
  try {
    for (;;) {
      Order o{};
      MPI_Bcast(&o, 4, MPI_DOUBLE, 0, MPI_COMM_WORLD);
      const int task = static_cast<int>(o.task);
      if (task == kRelease) return;
      if (task == kBuild) {
        for (auto& body : build(static_cast<int>(o.value), o.extra))
          owned.push_back(std::move(body));
        continue;
      }
      DistributedBody& body = *bodies().at(static_cast<int>(o.body));
      if (task == kDestroy) {
        const auto same = [&](const auto& one) { return one.get() == &body; };
        owned.erase(std::find_if(owned.begin(), owned.end(), same));
        continue;
      }
      DistributedBody::Parts& s = *body.parts_;
      switch (task) {
        case kSetStep:
          s.set_step(o.value);
          break;
        case kGather:
          s.gather(o.value, unused, none);
          break;
        case kAdvance: {
          MPI_Bcast(s.load.data(), static_cast<int>(s.load.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
          s.exchange.scatter({}, s.surface_force);
          s.advance();
          break;
        }
        case kEnergy:
          s.energy();
          break;
        case kMean:
          body.load_displacement(static_cast<int>(o.value));
          break;
        case kScatter:
          if (o.extra == 0)
            s.state()[static_cast<std::size_t>(o.value)]->everywhere(s.m);
          else
            body.load(std::vector<double>(5 * s.m.unknowns.count + 2 * s.load.size() + 3));
          break;
        default:
          throw RunError("an unknown order");
      }
    }
  } catch (const InputError&) {  // rank 0 has met the same and says so
  } catch (const std::exception& e) {
    std::fprintf(stderr, "trackbed: rank %d: %s\n", rank(), e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
}

}  // namespace trackbed::fem
