// A body whose cells, matrices and motion are shared by the ranks of mpirun, linear elastic or of a
// material with history: deal.II's distributed triangulation (p4est) says which rank owns which
// cell, each rank integrates its own cells, PETSc holds the matrices by rows and solves. Rank 0 owns the grains: it is given
// the motion of the surface nodes and gives the forces on them; nothing else crosses between ranks
// in a step but what products and solves need. (The mesh itself is known to all ranks, as p4est's
// coarse mesh is.)
//
// Rank 0 uses a DistributedBody as any other structure. All ranks construct it together; the others
// then call serve(), which does what rank 0 asks for until rank 0 calls release_ranks().
#pragma once
#include <functional>
#include <memory>

#include "fem/elastic_body.h"
#include "fem/materials/stress_model.h"

namespace trackbed::fem {

/// Builds on a rank other than 0 what rank 0 builds after ask_to_build(what, value).
using BuildTogether =
    std::function<std::vector<std::unique_ptr<Structure>>(int what, double value)>;

class DistributedBody final : public Structure {
 public:
  /// As ElasticBody or, with a stress model, as NonlinearBody, by all ranks together. \throws
  /// InputError as they do.
  explicit DistributedBody(ElasticBodyParameters, std::shared_ptr<const StressModel> = nullptr);
  ~DistributedBody() override;

  const SurfaceMesh& surface() const override;
  void set_step(double dt) override;
  double explicit_limit() const override;
  void predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  void advance(const std::vector<Vec>& surface_forces) override;
  void motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  int loads() const override;
  void set_load(int load, double newton) override;
  Vec load_displacement(int load) const override;
  double mass() const override;
  double least_surface_mass() const override;
  double largest_frequency() const override;  ///< 0 where the mass is not lumped
  double largest_step() const override;
  double contact_bound(const std::vector<NodeSpring>&) const override;
  int unknowns() const override;
  StructureEnergy energy() const override;
  /// The same for any number of ranks, and from run to run on several, to the solver's tolerance:
  /// sums over ranks are added as messages arrive. Bitwise on one. A material's history is gathered
  /// from the ranks that keep it.
  void save(std::vector<double>& state) const override;
  void load(const std::vector<double>& state) override;
  bool has_fields() const override { return true; }
  void write_vtu(const std::string& file) const override;

  int solver_iterations() const;           ///< of the last step's solve; 0 for a direct or no solve
  std::vector<int> rank_unknowns() const;  ///< that each rank owns
  /// That each rank evaluates in a step, of a material with history; else none.
  std::vector<int> rank_cells() const;

 private:
  friend void serve(const BuildTogether&);
  void take_part(int task, double value);
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// While one lives, the functions below make bodies that the ranks share (if there are several).
class BuildingTogether {
 public:
  BuildingTogether();
  ~BuildingTogether();
  BuildingTogether(const BuildingTogether&) = delete;
};

/// An ElasticBody, or a DistributedBody while BuildingTogether on several ranks.
std::unique_ptr<Structure> make_elastic_body(ElasticBodyParameters);
/// A NonlinearBody, or the same.
std::unique_ptr<Structure> make_body_with_history(ElasticBodyParameters,
                                                  std::shared_ptr<const StressModel>);

/// For ranks other than 0: builds bodies when rank 0 calls ask_to_build(), does its share of what
/// rank 0 does with them, destroys them when rank 0 does, until release_ranks().
void serve(const BuildTogether& build);

/// On rank 0, before it constructs bodies.
void ask_to_build(int what, double value);

/// On rank 0: the other ranks return from serve(). No bodies may be used after it.
void release_ranks();

}  // namespace trackbed::fem
