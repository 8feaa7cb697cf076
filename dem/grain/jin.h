// Irregular stones as Jin, Zeng, Ye, Li 2017 (section 2.1), from six parameters: the surface of a
// box L x W x H, each edge in N_d parts, is triangulated; every node's distance from the centre is
// multiplied by a random factor in [S_l, S_u] (1). The stone is seen as a whole from its centre, so
// it never cuts itself, but in general it is not convex.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/grain/random.h"
#include "dem/grain/triangle_solid.h"

namespace trackbed::dem {

struct JinParameters {
  double length = 0.0751, width = 0.0580, height = 0.0498;  ///< L, W, H along x, y, z [m]
  int divisions = 2;                                        ///< N_d [-]: 6 N_d^2 + 2 nodes
  double least_scale = 0.8, largest_scale = 1.2;            ///< S_l, S_u [-]
};

/// One stone, centre of the box at the origin. The paper's mesh is its mesher's; here each part of
/// a box face is cut into two triangles, along alternating diagonals. Throws InputError: an edge
/// that is not positive, divisions < 1, not 0 < S_l <= S_u.
TriangleSolid jin_stone(const JinParameters&, Random&);

/// L/H of stones is near log-normal (Fig 2; its parameters are lost with the figure).
struct LogNormal {
  double median = 1;     ///< [-]
  double deviation = 0;  ///< standard deviation of the logarithm [-]
};
double draw(const LogNormal&, Random&);
/// By mean and deviation of the logarithms. Throws InputError: fewer than two, or one not positive.
LogNormal fit_log_normal(const std::vector<double>& values);

struct JinStonesParameters {
  int count = 1000;
  std::uint64_t seed = 1;
  LogNormal length_over_height = {1.6, 0.2};  ///< L/H, values below 1 drawn again
  int divisions = 2;
  double least_scale = 0.8, largest_scale = 1.2;
};

/// Stones of W = 1 m; ln(W/H) / ln(L/H) is uniform in [0, 1]. Equal seeds, equal stones (on one
/// platform: exp and log are the library's). Throws as jin_stone; count < 1, median or deviation
/// that leave nothing above 1.
std::vector<TriangleSolid> jin_stones(const JinStonesParameters&);

}  // namespace trackbed::dem
