// What does not change while a body moves: its cells, unknowns, matrices, contact surface and
// loads. Shared by the full body and by its reduction. Internal: works with deal.II's grid.
#pragma once
#include <string>
#include <vector>

#include "fem/assembly.h"
#include "fem/elastic_body.h"
#include "fem/grid.h"
#include "fem/load_patch.h"
#include "fem/surface.h"

namespace trackbed::fem {

/// Whether the mass is lumped, as asked for or as the body needs it (see Mass). \throws InputError:
/// an explicit scheme by name with consistent mass, an unknown boundary of a bed.
bool lumped_mass(const ElasticBodyParameters&, const Discretisation&, const Unknowns&);

struct BodyModel {
  ElasticBodyParameters p;
  Grid grid;
  Discretisation body;
  Unknowns unknowns;
  Assembled assembled;
  ContactSurface surface;
  std::vector<LoadPatch> patches;

  /// \throws InputError as ElasticBody's constructor does.
  explicit BodyModel(ElasticBodyParameters);

  const Matrices& matrices() const { return assembled.matrices; }
  bool has_gravity() const;
  double mass() const;                ///< [kg]
  double least_surface_mass() const;  ///< [kg]
  std::string free_motion() const;    ///< "" if held

  /// Value of a field of unknowns at a node; 0 where it is held.
  Vec at(const std::vector<double>& field, int node) const;
  std::vector<Vec> everywhere(const std::vector<double>& field) const;
  void add(int node, const Vec& force, double factor, std::vector<double>& to) const;

  /// f = gravity + loads [N].
  void outer_force(const std::vector<double>& load, std::vector<double>& f) const;
  void add_surface(const std::vector<Vec>& forces, std::vector<double>& f) const;
  /// \throws RunError unless there is one finite force a surface node.
  void check(const std::vector<Vec>& forces) const;

  /// Mean of a field over the patch of a load, weighted as the load is.
  Vec patch_mean(int load, const std::vector<double>& field) const;
};

}  // namespace trackbed::fem
