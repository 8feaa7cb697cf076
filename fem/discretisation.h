// A body's nodes, cells and boundary faces as plain arrays: all that the rest of the library needs
// once deal.II has made them.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "fem/structure.h"

namespace trackbed::fem {

/// A face on the boundary. Nodes in rows, side by side (4: 2×2, 9: 3×3); along the row × along the
/// columns points out of the body.
struct Face {
  std::array<int, 9> nodes{};
  int count = 4;
  int boundary = 0;
  int cell = 0;  ///< that it belongs to
};

struct Discretisation {
  std::vector<Vec> position;  ///< of the nodes [m]
  int nodes_per_cell = 8;
  std::vector<int> cell_nodes;  ///< nodes_per_cell a cell, deal.II's order
  std::vector<Face> faces;
  std::map<std::string, int> boundaries;  ///< name -> Face::boundary

  int nodes() const { return static_cast<int>(position.size()); }
};

/// Unknown of each node and direction: -1 if it is held; periodic images share one.
struct Unknowns {
  std::vector<std::array<int, 3>> of_node;
  std::vector<int> same_as;  ///< per node: the node it is the image of, or itself
  Vec period{0, 0, 0};
  int count = 0;
};

/// A point of a face by quadrature: weights of its nodes, unit outward normal, area.
struct FacePoint {
  std::array<double, 9> shape{};
  Vec place{}, normal{};
  double area = 0;
};

/// Quadrature of a face (exact for its shape functions squared on parallelograms).
std::vector<FacePoint> face_points(const Discretisation&, const Face&);
/// Shape functions of a face with `count` nodes at ξ, η in [0, 1].
std::array<double, 9> face_shape(int count, double xi, double eta);

}  // namespace trackbed::fem
