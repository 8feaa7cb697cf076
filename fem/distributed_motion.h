// The motion of a body shared by ranks, and its step in time. All functions are called by all ranks
// together. Internal: PETSc.
#pragma once
#include <memory>
#include <vector>

#include "fem/distributed_algebra.h"
#include "fem/materials/stress_model.h"
#include "fem/time_integration.h"

namespace trackbed::fem {

class DistributedMotion {
 public:
  virtual ~DistributedMotion() = default;

  virtual bool is_static() const { return false; }
  virtual bool is_explicit() const = 0;
  virtual double explicit_limit() const = 0;  ///< as Structure's
  virtual double largest_step() const { return std::numeric_limits<double>::infinity(); }
  virtual double largest_frequency() const = 0;  ///< [rad/s], 2 % safe; 0 if not lumped
  virtual double step() const = 0;
  virtual int iterations() const { return 0; }
  virtual std::vector<int> rank_cells() const { return {}; }  ///< that each evaluates in a step

  /// \throws RunError if the matrix cannot be factorised. That the step is within largest_step() is
  /// the caller's affair: all ranks must find the same.
  virtual void set_step(double dt) = 0;

  /// From t to t+Δt under the outer force at t+Δt.
  virtual void advance(const DistributedVector& force) = 0;

  /// To the state at t = 0 under the outer force f: its static answer, or a = M⁻¹ f at rest.
  virtual void start(bool in_equilibrium) = 0;

  /// Where the unknowns will be at t+Δt, exact if explicit, and how fast.
  virtual void predict(DistributedVector& displacement, DistributedVector& velocity) = 0;

  virtual double kinetic() = 0;  ///< [J]
  virtual double strain() = 0;
  virtual double gravity() = 0;
  virtual double plastic() const { return 0; }  ///< dissipated in the material

  /// Dissipated in the step from `before` by all damping, and by dashpots of boundaries alone [J].
  struct Loss {
    double all = 0, boundary = 0;
  };
  /// `moved` = u₊ − u, `v_before` = v, which is overwritten by the mean of both velocities.
  virtual Loss loss(const DistributedVector& /*moved*/, DistributedVector& /*v_before*/) {
    return {};
  }

  /// All that a checkpoint holds of it: fields of unknowns, and what else there is, whole on rank 0.
  virtual std::vector<DistributedVector*> state() { return {&u, &v, &a, &f}; }
  virtual std::size_t more_state_size() const { return 0; }
  virtual std::vector<double> more_state() { return {}; }
  virtual void take_more_state(const double*) {}

  /// Mean stress of each cell [Pa], whole on rank 0; none: that of the linear elastic body.
  virtual std::vector<Voigt> cell_stress() { return {}; }

  DistributedVector u, v, a, f;
};

/// Of a linear elastic body: the schemes of time_integration.h on PETSc's vectors. The matrices must
/// outlive it. \throws InputError for a static body that is not held.
std::unique_ptr<DistributedMotion> make_linear_motion(const DistributedMatrices&);

/// Of one whose stress has a history (history_motion.h); matrices of history_parameters().
/// \throws InputError if the stress in situ is not elastic.
std::unique_ptr<DistributedMotion> make_history_motion(const DistributedMatrices&,
                                                       std::shared_ptr<const StressModel>);

}  // namespace trackbed::fem
