#include "fem/discretisation.h"

#include <cmath>

namespace trackbed::fem {
namespace {

// Lagrange polynomials on [0, 1] and their derivatives: 2 or 3 points.
void line(int n, double t, double* value, double* slope) {
  if (n == 2) {
    value[0] = 1 - t, value[1] = t;
    slope[0] = -1, slope[1] = 1;
  } else {
    value[0] = (1 - t) * (1 - 2 * t), value[1] = 4 * t * (1 - t), value[2] = t * (2 * t - 1);
    slope[0] = 4 * t - 3, slope[1] = 4 - 8 * t, slope[2] = 4 * t - 1;
  }
}

}  // namespace

std::array<double, 9> face_shape(int count, double xi, double eta) {
  const int n = count == 4 ? 2 : 3;
  double a[3], b[3], unused[3];
  line(n, xi, a, unused);
  line(n, eta, b, unused);
  std::array<double, 9> shape{};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) shape[j * n + i] = a[i] * b[j];
  return shape;
}

std::vector<FacePoint> face_points(const Discretisation& body, const Face& face) {
  static const double g = std::sqrt(0.6) / 2, x[3] = {0.5 - g, 0.5, 0.5 + g},
                      w[3] = {5. / 18, 8. / 18, 5. / 18};
  const int n = face.count == 4 ? 2 : 3;
  std::vector<FacePoint> points;
  for (int q = 0; q < 9; ++q) {
    double a[3], b[3], da[3], db[3];
    line(n, x[q % 3], a, da);
    line(n, x[q / 3], b, db);
    FacePoint p;
    Vec along{}, across{};
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec& node = body.position[face.nodes[j * n + i]];
        p.shape[j * n + i] = a[i] * b[j];
        for (int d = 0; d < 3; ++d) {
          p.place[d] += a[i] * b[j] * node[d];
          along[d] += da[i] * b[j] * node[d];
          across[d] += a[i] * db[j] * node[d];
        }
      }
    for (int d = 0; d < 3; ++d) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      p.normal[d] = along[e] * across[f] - along[f] * across[e];
    }
    const double size = std::sqrt(p.normal[0] * p.normal[0] + p.normal[1] * p.normal[1] +
                                  p.normal[2] * p.normal[2]);
    for (double& c : p.normal) c /= size;
    p.area = size * w[q % 3] * w[q / 3];
    points.push_back(p);
  }
  return points;
}

}  // namespace trackbed::fem
