// A body of hexahedra whose stress a StressModel gives: plasticity, history, in-situ stress.
//
// Displacements count from the state in situ, whose stresses balance the soil's own weight; how it
// moves: fem/history_motion.h. On one process; DistributedBody shares such a body by ranks.
#pragma once
#include <memory>

#include "fem/elastic_body.h"
#include "fem/materials/stress_model.h"

namespace trackbed::fem {

class NonlinearBody final : public Structure {
 public:
  /// Mesh, supports, contact surface, solver and time integration as for an ElasticBody; materials,
  /// loads and gravity are not used, beds are refused. \throws InputError as ElasticBody.
  NonlinearBody(ElasticBodyParameters, std::shared_ptr<const StressModel>);
  ~NonlinearBody() override;

  const SurfaceMesh& surface() const override;
  void set_step(double dt) override;
  double explicit_limit() const override;
  void predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  /// \throws RunError when Newton's iteration does not converge.
  void advance(const std::vector<Vec>& surface_forces) override;
  void motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  int loads() const override { return 0; }
  void set_load(int load, double newton) override;
  Vec load_displacement(int load) const override;
  double mass() const override;
  double least_surface_mass() const override;
  double largest_frequency() const override;
  /// By nodes; and ω_max² more where it goes without a solve.
  double contact_bound(const std::vector<NodeSpring>&) const override;
  int unknowns() const override;
  StructureEnergy energy() const override;
  /// Motion, history of all points, totals.
  void save(std::vector<double>& state) const override;
  void load(const std::vector<double>& state) override;

  /// From where it stands to rest under these forces [N], raised in `load_steps` equal steps;
  /// v = a = 0 afterwards. Returns the residuals of the last load step's iterations over the
  /// forces. \throws RunError when an iteration does not converge: more load than the body bears.
  std::vector<double> solve_static(const std::vector<Vec>& surface_forces, int load_steps = 1);

  /// Displacement [m] at a point. \throws InputError outside the body.
  Vec displacement_at(const Vec& point) const;

  /// Mean stress of each cell [Pa], in-situ stress included.
  std::vector<Voigt> cell_stress() const;

  bool has_fields() const override { return true; }
  void write_vtu(const std::string& file) const override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace trackbed::fem
