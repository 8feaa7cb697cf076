// Branch and bound over the directions u of a hole's side: the search that exact sieve sizes of
// polyhedra and of clumps share.
#pragma once
#include "dem/grading/sieve_size.h"

namespace trackbed::dem {

/// Least and largest value of R cos over the angles within t of one where it is `value`, R^2 =
/// radius2, R >= value >= 0; c = cos t, s = sin t.
double lowest_near(double value, double radius2, double c, double s);
double highest_near(double value, double radius2, double c, double s);

/// f* = min over orthonormal (u, v) of max(w(u), w(v)) = min over u of max(w(u), g(u)), where
/// g(u) = min over v orthogonal to u of w(v) is the least width of the shadow along u. By symmetry
/// of u and v it is enough to search where w(u) >= g(u): otherwise exchange the two. Without that,
/// a box 64 x 30 x 100 has a whole arc of optimal u; with it optima are isolated corners, towards
/// which bounds close in linearly.
class DirectionSearch {
 public:
  virtual ~DirectionSearch() = default;
  ExactSieveSize run(double tolerance);

 protected:
  DirectionSearch();

  struct Bounds {
    double w = 0, g = 0;                      ///< at u
    double w_low = 0, w_high = 0, g_low = 0;  ///< for all directions of the cap about u
    Vec3 v = Vec3::Zero();                    ///< where g is attained
  };
  /// Value and bounds for the cap of cosine c, sine s about u. May return early, with g infinite,
  /// when w_low >= best().size.
  virtual Bounds evaluate(const Vec3& u, double c, double s) = 0;
  const ExactSieveSize& best() const { return best_; }

 private:
  Bounds evaluate_and_keep(const Vec3& u, double c, double s);
  double value_at(const Vec3& u);
  void descend(Vec3 u, double step);
  ExactSieveSize best_;
};

}  // namespace trackbed::dem
