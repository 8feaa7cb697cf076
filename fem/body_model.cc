#include "fem/body_model.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/session.h"
#include "fem/supports.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

double inner(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

const ElasticBodyParameters& checked(const ElasticBodyParameters& p) {
  if (p.order != 1 && p.order != 2)
    throw InputError(text(p.name, ": element order ", p.order, ", allowed are 1 and 2"));
  if (p.materials.empty()) throw InputError(p.name + ": no material given");
  return p;
}

Discretisation make(const ElasticBodyParameters& p, Grid& grid) {
  start_session();  // from here on one thread inside deal.II: sums come out the same every time
  make_cells(p, grid);
  return discretise(grid);
}

}  // namespace

bool lumped_mass(const ElasticBodyParameters& p, const Discretisation& body,
                 const Unknowns& unknowns) {
  for (const Bed& bed : p.beds) find_boundary(body, p.name, "bed", bed.boundary);
  const bool needed = p.scheme == TimeScheme::central_difference || p.scheme == TimeScheme::zhai;
  if (p.mass == Mass::consistent && needed)
    throw InputError(p.name + ": central_difference and zhai need lumped mass, not consistent");
  if (needed) return true;
  if (p.mass == Mass::automatic) return free_motion(body, unknowns, p.beds).empty();
  return p.mass == Mass::lumped;
}

BodyModel::BodyModel(ElasticBodyParameters given)
    : p(std::move(given)),
      grid(checked(p).order),
      body(make(p, grid)),
      unknowns(number_unknowns(body, p.name, p.supports)),
      assembled(assemble(p, grid, body, unknowns, lumped_mass(p, body, unknowns))),
      surface(contact_surface(body, unknowns, p.name, p.contact)) {
  assembled.matrices.rigid = rigid_motions(body, unknowns);
  for (const Load& l : p.loads) patches.push_back(load_patch(body, p.name, l));
}

bool BodyModel::has_gravity() const { return inner(p.gravity, p.gravity) > 0; }

double BodyModel::mass() const {
  double sum = 0;
  for (double m : assembled.node_mass) sum += m;
  return sum;
}

double BodyModel::least_surface_mass() const {
  std::vector<double> mass(body.nodes(), 0.);  // images share a node
  for (int i = 0; i < body.nodes(); ++i) mass[unknowns.same_as[i]] += assembled.node_mass[i];
  double least = std::numeric_limits<double>::infinity();
  for (int node : surface.node) {
    const auto& ids = unknowns.of_node[node];
    if (std::max({ids[0], ids[1], ids[2]}) >= 0)
      least = std::min(least, mass[unknowns.same_as[node]]);
  }
  return least;
}

std::string BodyModel::free_motion() const { return fem::free_motion(body, unknowns, p.beds); }

Vec BodyModel::at(const std::vector<double>& field, int node) const {
  Vec value{};
  for (int d = 0; d < 3; ++d)
    if (const int i = unknowns.of_node[node][d]; i >= 0) value[d] = field[i];
  return value;
}

std::vector<Vec> BodyModel::everywhere(const std::vector<double>& field) const {
  std::vector<Vec> values(body.nodes());
  for (int i = 0; i < body.nodes(); ++i) values[i] = at(field, i);
  return values;
}

void BodyModel::add(int node, const Vec& f, double factor, std::vector<double>& to) const {
  for (int d = 0; d < 3; ++d)
    if (const int i = unknowns.of_node[node][d]; i >= 0) to[i] += factor * f[d];
}

void BodyModel::outer_force(const std::vector<double>& load, std::vector<double>& f) const {
  std::fill(f.begin(), f.end(), 0.);
  if (has_gravity())
    for (int i = 0; i < body.nodes(); ++i) add(i, p.gravity, assembled.node_mass[i], f);
  for (std::size_t l = 0; l < patches.size(); ++l)
    if (load[l] != 0)
      for (const auto& [node, weight] : patches[l].weights)
        add(node, patches[l].direction, weight * load[l], f);
}

void BodyModel::add_surface(const std::vector<Vec>& forces, std::vector<double>& f) const {
  for (std::size_t i = 0; i < forces.size(); ++i) add(surface.node[i], forces[i], 1., f);
}

void BodyModel::check(const std::vector<Vec>& forces) const {
  if (forces.size() != surface.node.size())
    throw RunError(
        text(p.name, ": ", forces.size(), " surface forces for ", surface.node.size(), " nodes"));
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (!std::isfinite(inner(forces[i], forces[i])))
      throw RunError(text(p.name, ": the contact force on surface node ", i,
                          " is not finite; the time step is probably too large"));
}

Vec BodyModel::patch_mean(int l, const std::vector<double>& field) const {
  Vec mean{};
  for (const auto& [node, weight] : patches[l].weights) {
    const Vec value = at(field, node);
    for (int d = 0; d < 3; ++d) mean[d] += weight * value[d];
  }
  return mean;
}

}  // namespace trackbed::fem
