#include "fem/distributed_body.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <stdexcept>

#include "base/error.h"
#include "fem/contact_bound.h"
#include "fem/distributed_motion.h"
#include "fem/history_cells.h"
#include "fem/load_patch.h"
#include "fem/nonlinear_body.h"
#include "fem/output.h"
#include "fem/session.h"
#include "fem/surface.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// What rank 0 asks the others to take part in.
enum Task {
  kRelease,
  kBuild,
  kSetStep,
  kGather,
  kAdvance,
  kEnergy,
  kMean,
  kField,
  kMoreState,
  kLoad,
  kStress,
  kPush,
  kDestroy
};
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

}  // namespace

// All functions here are called by all ranks together, unless they say otherwise.
struct DistributedBody::Parts {
  DistributedMatrices m;
  ContactSurface surface;
  std::vector<LoadPatch> patches;
  std::unique_ptr<DistributedMotion> motion;
  int number;  // among the bodies

  DistributedVector force, surface_force, surface_before, before, v_before, values;
  std::vector<DistributedVector> load_weight;  // of a positive force
  SurfaceExchange exchange;
  std::vector<double> load, load_before;
  std::unique_ptr<DistributedSolver> inertia;  // of a consistent mass, when first needed
  DistributedVector pushed;
  // Ledger [J].
  double work_loads = 0, work_surface = 0, damping = 0, boundary = 0, at_start = 0;

  Parts(ElasticBodyParameters p, std::shared_ptr<const StressModel> stress)
      : m(stress ? history_parameters(std::move(p), stress->density()) : std::move(p)),
        surface(contact_surface(m.body, m.unknowns, m.p.name, m.p.contact)),
        motion(stress ? make_history_motion(m, std::move(stress)) : make_linear_motion(m)),
        number(next_number++),
        exchange(m, surface.node) {
    for (auto* x : {&force, &surface_force, &surface_before, &before, &v_before, &values, &pushed})
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
    if (inner(m.p.gravity, m.p.gravity) > 0) {
      outer_force(motion->f);
      motion->start(m.p.start_in_equilibrium && m.held);
    }
    at_start = motion->kinetic() + motion->strain() + motion->gravity();
  }

  void outer_force(DistributedVector& to) {
    to.copy(m.gravity);
    for (std::size_t l = 0; l < load.size(); ++l) to.add_scaled(load[l], load_weight[l]);
  }

  // With the forces on the surface in `surface_force` and the loads set.
  void advance() {
    outer_force(force);
    force.add_scaled(1, surface_force);
    before.copy(motion->u);
    v_before.copy(motion->v);
    motion->advance(force);
    before.scale(-1);
    before.add_scaled(1, motion->u);
    const DistributedVector& moved = before;
    surface_before.add_scaled(1, surface_force);
    work_surface += surface_before.dot(moved) / 2;
    surface_before.copy(surface_force);
    for (std::size_t l = 0; l < load.size(); ++l) {
      const double sum = load[l] + load_before[l];
      if (sum != 0) work_loads += sum / 2 * load_weight[l].dot(moved);
      load_before[l] = load[l];
    }
    const DistributedMotion::Loss loss = motion->loss(moved, v_before);
    boundary += loss.boundary;
    damping += loss.all - loss.boundary;
  }

  // Surface values on rank 0, of now or at t+Δt.
  void gather(bool ahead, std::vector<Vec>& displacement, std::vector<Vec>& velocity) {
    if (ahead) motion->predict(values, v_before);
    exchange.gather(ahead ? values : motion->u, displacement);
    exchange.gather(ahead ? v_before : motion->v, velocity);
  }

  // M⁻¹ of forces on the surface, there; `forces` of rank 0 count, `accelerations` are for it.
  void push(const std::vector<Vec>& forces, std::vector<Vec>& accelerations) {
    if (!inertia) inertia = std::make_unique<DistributedSolver>(m, m.consistent, m.p.solver);
    exchange.scatter(forces, values);
    pushed.scale(0);
    inertia->solve(values, pushed);
    exchange.gather(pushed, accelerations);
  }

  StructureEnergy energy() {
    StructureEnergy e;
    e.kinetic = motion->kinetic(), e.strain = motion->strain(), e.gravity = motion->gravity();
    e.work_loads = work_loads, e.work_surface = work_surface;
    e.dissipated_damping = damping, e.dissipated_boundary = boundary;
    e.dissipated_material = motion->plastic();
    e.at_start = at_start;
    e.numerical = e.work_loads + e.work_surface + e.at_start - e.kinetic - e.strain - e.gravity -
                  e.dissipated_damping - e.dissipated_boundary - e.dissipated_material;
    return e;
  }

  std::vector<DistributedVector*> state() {
    std::vector<DistributedVector*> all = motion->state();
    all.push_back(&surface_before);
    return all;
  }
  std::vector<double*> totals() {
    return {&work_loads, &work_surface, &damping, &boundary, &at_start};
  }
  std::size_t state_size() {
    return state().size() * m.unknowns.count + 2 * load.size() + totals().size() +
           motion->more_state_size();
  }

  // Rank 0's share of an order.
  void order(double task, double value = 0) const {
    if (first_rank()) give(task, number, value);
  }
};

DistributedBody::DistributedBody(ElasticBodyParameters p, std::shared_ptr<const StressModel> stress)
    : parts_(nullptr) {
  start_session();
  parts_ = std::make_unique<Parts>(std::move(p), std::move(stress));
  bodies()[parts_->number] = this;
}

DistributedBody::~DistributedBody() {
  // PETSc's objects go on all ranks together.
  if (served && ranks() > 1) parts_->order(kDestroy);
  bodies().erase(parts_->number);
}

const SurfaceMesh& DistributedBody::surface() const { return parts_->surface.mesh; }
double DistributedBody::explicit_limit() const { return parts_->motion->explicit_limit(); }
double DistributedBody::largest_step() const { return parts_->motion->largest_step(); }
int DistributedBody::loads() const { return static_cast<int>(parts_->patches.size()); }
double DistributedBody::mass() const { return parts_->m.mass(); }
double DistributedBody::least_surface_mass() const {
  return parts_->motion->is_static() ? std::numeric_limits<double>::infinity()
                                     : parts_->m.least_mass(parts_->surface.node);
}
double DistributedBody::largest_frequency() const { return parts_->motion->largest_frequency(); }
double DistributedBody::contact_bound(const std::vector<NodeSpring>& springs) const {
  Parts& s = *parts_;
  if (s.motion->is_explicit()) {
    const double own = (std::isfinite(largest_step()) ? 2 : 0.9 * 2) / explicit_limit();  // omega
    return Structure::contact_bound(springs) + own * own;
  }
  if (s.motion->is_static() || s.m.lumped) return Structure::contact_bound(springs);
  return largest_contact_eigenvalue(springs, static_cast<int>(s.surface.node.size()),
                                    [&](const auto& forces, auto& accelerations) {
                                      s.order(kPush);
                                      s.push(forces, accelerations);
                                    });
}
int DistributedBody::unknowns() const { return parts_->m.unknowns.count; }
int DistributedBody::solver_iterations() const { return parts_->motion->iterations(); }
std::vector<int> DistributedBody::rank_unknowns() const { return parts_->m.rows_of_rank; }
std::vector<int> DistributedBody::rank_cells() const { return parts_->motion->rank_cells(); }

void DistributedBody::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  if (dt > largest_step())
    throw InputError(text("time step of the structure: ", dt, " s is over the limit ",
                          largest_step(),
                          " s of its explicit scheme; take a smaller one, a coarser "
                          "mesh or an implicit scheme"));
  if (dt == parts_->motion->step()) return;
  parts_->order(kSetStep, dt);
  parts_->motion->set_step(dt);
}

void DistributedBody::predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  parts_->order(kGather, 1);
  parts_->gather(true, displacement, velocity);
}

void DistributedBody::motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const {
  parts_->order(kGather, 0);
  parts_->gather(false, displacement, velocity);
}

void DistributedBody::set_load(int load, double newton) {
  if (!std::isfinite(newton))
    throw RunError(
        text(parts_->m.p.name, ": load '", parts_->m.p.loads.at(load).name, "' is not finite"));
  parts_->load.at(load) = newton;
}

void DistributedBody::advance(const std::vector<Vec>& forces) {
  Parts& s = *parts_;
  if (!(s.motion->step() > 0)) throw RunError("structure: set_step() must come before advance()");
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
    for (int d = 0; d < 3; ++d) mean[d] += weight * s.motion->u.own(s.m, node, d);
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
  const auto append = [&](const std::vector<double>& values) {
    state.insert(state.end(), values.begin(), values.end());
  };
  int k = 0;
  for (DistributedVector* x : s.state()) {
    s.order(kField, k++);
    append(x->everywhere(s.m));
  }
  append(s.load), append(s.load_before);
  for (const double* total : s.totals()) state.push_back(*total);
  s.order(kMoreState);
  append(s.motion->more_state());
}

void DistributedBody::load(const std::vector<double>& state) {
  Parts& s = *parts_;
  const std::size_t n = s.m.unknowns.count, loads = s.load.size();
  if (state.size() != s.state_size())
    throw InputError(text(s.m.p.name, ": the saved state has ", state.size(),
                          " numbers, this body needs ", s.state_size(),
                          "; it belongs to another mesh or was written without mpirun"));
  s.order(kLoad);
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
  for (double* total : s.totals()) *total = *from++;
  s.motion->take_more_state(copy.data() + (from - copy.begin()));
}

void DistributedBody::write_vtu(const std::string& file) const {
  Parts& s = *parts_;
  s.order(kField, 0);
  const auto u = s.motion->u.everywhere(s.m);
  s.order(kField, 1);
  const auto v = s.motion->v.everywhere(s.m);
  s.order(kStress);
  const auto stress = s.motion->cell_stress();
  if (stress.empty())
    write_fields(file, s.m.p, s.m.grid, s.m.body, s.m.at_nodes(u), s.m.at_nodes(v));
  else
    write_fields(file, s.m.p, s.m.grid, s.m.body, s.m.at_nodes(u), s.m.at_nodes(v), stress);
}

BuildingTogether::BuildingTogether() { together = true; }
BuildingTogether::~BuildingTogether() { together = false; }

std::unique_ptr<Structure> make_elastic_body(ElasticBodyParameters p) {
  if (together && ranks() > 1) return std::make_unique<DistributedBody>(std::move(p));
  return std::make_unique<ElasticBody>(std::move(p));
}

std::unique_ptr<Structure> make_body_with_history(ElasticBodyParameters p,
                                                  std::shared_ptr<const StressModel> stress) {
  if (together && ranks() > 1)
    return std::make_unique<DistributedBody>(std::move(p), std::move(stress));
  return std::make_unique<NonlinearBody>(std::move(p), std::move(stress));
}

void ask_to_build(int what, double value) {
  if (ranks() > 1 && first_rank()) give(kBuild, 0, what, value);
}

void release_ranks() {
  if (ranks() > 1 && first_rank() && served) give(kRelease);
  served = false;
}

// The share of a rank other than 0 in what rank 0 does.
void DistributedBody::take_part(int task, double value) {
  Parts& s = *parts_;
  std::vector<Vec> unused, none;
  switch (task) {
    case kSetStep:
      return s.motion->set_step(value);
    case kGather:
      return s.gather(value > 0, unused, none);
    case kAdvance:
      MPI_Bcast(s.load.data(), static_cast<int>(s.load.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
      s.exchange.scatter({}, s.surface_force);
      return s.advance();
    case kEnergy:
      s.energy();
      return;
    case kPush:
      return s.push({}, unused);
    case kMean:
      load_displacement(static_cast<int>(value));
      return;
    case kField:
      s.state()[static_cast<std::size_t>(value)]->everywhere(s.m);
      return;
    case kMoreState:
      s.motion->more_state();
      return;
    case kLoad:
      return load(std::vector<double>(s.state_size()));
    case kStress:
      s.motion->cell_stress();
      return;
    default:
      throw std::logic_error("an unknown order");
  }
}

void serve(const BuildTogether& build) {
  std::vector<std::unique_ptr<Structure>> owned;
  for (;;) {
    try {
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
      body.take_part(task, o.value);
    } catch (const InputError&) {  // rank 0 has met the same and says so
      return;
    } catch (const RunError&) {  // the same, and it may have more to ask
    } catch (const std::exception& e) {
      std::fprintf(stderr, "trackbed: rank %d: %s\n", rank(), e.what());
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
  }
}

}  // namespace trackbed::fem
