// Lowest frequencies of a body against a dense solver of the same matrices.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "fem/body_model.h"
#include "fem/frequencies.h"

using namespace trackbed::fem;

// A cube has a sixfold frequency 0 and many two- and threefold ones; on rollers some rigid motions
// are left. Each must be found as often as a dense solver finds it.
TEST(Modes, MultipleFrequenciesAreAllFound) {
  for (const int held : {0, 1, 2}) {
    ElasticBodyParameters p;
    p.name = "Cube";
    p.materials = {{"concrete", 40e9, 0.2, 2400}};
    p.mesh.corner = {3, -2, 1};
    p.mesh.lengths = {1, 1, 1};
    p.mesh.elements = {3, 3, 3};
    p.loads = {};
    if (held > 0) p.supports["x_min"] = Support::roller;
    if (held > 1) p.supports["bottom"] = Support::roller;
    const BodyModel body(p);
    const Matrices& m = body.matrices();
    const int n = m.pattern.rows();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), M = K;
    for (int i = 0; i < n; ++i)
      for (int e = m.pattern.start[i]; e < m.pattern.start[i + 1]; ++e)
        K(i, m.pattern.column[e]) = m.stiffness[e], M(i, m.pattern.column[e]) = m.mass[e];
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M);
    const Modes modes = lowest_modes(m, 24);
    ASSERT_EQ(modes.frequency.size(), 24);
    const int rigid = held == 0 ? 6 : held == 1 ? 3 : 1;
    const double top = std::sqrt(dense.eigenvalues()[23]) / (2 * M_PI);
    for (int k = 0; k < 24; ++k) {
      const double exact = std::sqrt(std::max(dense.eigenvalues()[k], 0.)) / (2 * M_PI);
      EXPECT_NEAR(modes.frequency[k], exact, (k < rigid ? 1e-4 : 1e-8) * top) << held << " " << k;
    }
    EXPECT_EQ(modes.frequency[rigid - 1], 0);
    EXPECT_GT(modes.frequency[rigid], 0.01 * top);
    for (int j = 0; j < 24; ++j)
      for (int k = 0; k <= j; ++k) {
        std::vector<double> x;
        multiply(m.pattern, m.mass, modes.shape[j], x);
        EXPECT_NEAR(dot(modes.shape[k], x), j == k, 1e-8) << held << " " << j << " " << k;
      }
  }
}
