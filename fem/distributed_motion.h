// The motion of a body shared by ranks, and its step in time: the schemes of time_integration.h on
// PETSc's vectors. All functions are called by all ranks together. Internal: PETSc.
#pragma once
#include <memory>
#include <vector>

#include "fem/distributed_algebra.h"
#include "fem/time_integration.h"

namespace trackbed::fem {

class DistributedMotion {
 public:
  /// At rest; the matrices must outlive it. \throws InputError for a static body that is not held.
  explicit DistributedMotion(const DistributedMatrices&);

  bool is_static() const { return scheme_.kind == TimeScheme::quasi_static; }
  bool is_explicit() const { return explicit_; }
  double explicit_limit() const { return explicit_limit_; }  ///< as Structure's
  double largest_step() const { return largest_step_; }      ///< as Structure's
  double step() const { return dt_; }
  int iterations() const { return solver_ ? solver_->iterations() : 0; }

  /// \throws RunError if the matrix cannot be factorised. That the step is within largest_step() is
  /// the caller's affair: all ranks must find the same.
  void set_step(double dt);

  /// From t to t+Δt under the outer force at t+Δt.
  void advance(const DistributedVector& force);

  /// The static answer to the outer force f.
  void settle();
  /// a = M⁻¹ f: of a body at rest and undeformed.
  void start_free();

  /// Where the unknowns will be at t+Δt, exact if explicit, and how fast.
  void predict(DistributedVector& displacement, DistributedVector& velocity) const;

  double kinetic();  ///< [J]
  double strain();
  /// Dissipated in the step from `before` by all damping, and by dashpots of boundaries alone [J].
  struct Loss {
    double all = 0, boundary = 0;
  };
  /// `moved` = u₊ − u, `v_before` = v, which is overwritten by the mean of both velocities.
  Loss loss(const DistributedVector& moved, DistributedVector& v_before);

  /// All that a checkpoint holds of it.
  std::vector<DistributedVector*> state();

  DistributedVector u, v, a, f;

 private:
  void advance_statically(const DistributedVector& force);
  void advance_explicitly(const DistributedVector& force);
  void advance_zhai(const DistributedVector& force);
  void advance_implicitly(const DistributedVector& force);
  void accelerate(const DistributedVector& force);

  const DistributedMatrices& m_;
  Scheme scheme_;
  double dt_ = 0, explicit_limit_ = 0;
  double largest_step_ = std::numeric_limits<double>::infinity();
  bool explicit_ = false;
  std::unique_ptr<DistributedSolver> solver_;
  DistributedVector a_before_;  // of Zhai: a step earlier
  DistributedVector work_, rhs_;
};

}  // namespace trackbed::fem
