#include "fem/load_patch.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "fem/supports.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

using Weights = std::map<int, double>;

void add(const Face& face, const std::array<double, 9>& shape, double factor, Weights& weights) {
  for (int i = 0; i < face.count; ++i) weights[face.nodes[i]] += factor * shape[i];
}

void whole_boundary(const Discretisation& body, int id, Weights& weights) {
  double area = 0;
  for (const Face& face : body.faces)
    if (face.boundary == id)
      for (const FacePoint& p : face_points(body, face)) area += p.area;
  for (const Face& face : body.faces)
    if (face.boundary == id)
      for (const FacePoint& p : face_points(body, face)) add(face, p.shape, p.area / area, weights);
}

// ξ, η of (x, y) in the face seen from above, by Newton on its bilinear map; false outside.
bool inside(const Discretisation& body, const Face& face, double x, double y, double& xi,
            double& eta) {
  const int n = face.count == 4 ? 2 : 3;
  const Vec* corner[4] = {&body.position[face.nodes[0]], &body.position[face.nodes[n - 1]],
                          &body.position[face.nodes[n * n - n]],
                          &body.position[face.nodes[n * n - 1]]};
  const auto beyond = [&](int d, double t) {
    double low = (*corner[0])[d], high = low;
    for (const Vec* c : corner) low = std::min(low, (*c)[d]), high = std::max(high, (*c)[d]);
    const double slack = 1e-9 * (high - low);
    return t < low - slack || t > high + slack;
  };
  if (beyond(0, x) || beyond(1, y)) return false;
  xi = eta = 0.5;
  for (int step = 0; step < 30; ++step) {
    double r[2] = {-x, -y}, a[2] = {0, 0}, b[2] = {0, 0};
    for (int d = 0; d < 2; ++d) {
      const double p = (*corner[0])[d], q = (*corner[1])[d], s = (*corner[2])[d],
                   t = (*corner[3])[d];
      r[d] += (1 - eta) * ((1 - xi) * p + xi * q) + eta * ((1 - xi) * s + xi * t);
      a[d] = (1 - eta) * (q - p) + eta * (t - s);
      b[d] = (1 - xi) * (s - p) + xi * (t - q);
    }
    const double det = a[0] * b[1] - a[1] * b[0];
    if (!(std::abs(det) > 0)) return false;
    const double dxi = (r[0] * b[1] - r[1] * b[0]) / det, deta = (a[0] * r[1] - a[1] * r[0]) / det;
    xi -= dxi;
    eta -= deta;
    if (std::abs(dxi) + std::abs(deta) < 1e-15) break;
  }
  const double slack = 1e-9;
  return xi > -slack && xi < 1 + slack && eta > -slack && eta < 1 + slack;
}

// Points of the rectangle with equal weight (Gauss in pieces): resultant and moment are exact, for
// the faces' shape functions reproduce 1, x and y.
void rectangle(const Discretisation& body, int id, const std::string& name, const Load& load,
               Weights& weights) {
  if (!(load.size_x > 0) || !(load.size_y > 0))
    throw InputError(text(name, ": load '", load.name, "': rectangle ", load.size_x, " x ",
                          load.size_y, " m, both sides must be positive"));
  constexpr int pieces = 32;
  const double gauss = 0.5 / std::sqrt(3.), share = 1. / (4. * pieces * pieces);
  std::vector<const Face*> faces;
  for (const Face& face : body.faces)
    if (face.boundary == id) faces.push_back(&face);
  std::size_t last = 0;  // neighbours in the raster are mostly on the same face
  for (int i = 0; i < 2 * pieces; ++i)
    for (int j = 0; j < 2 * pieces; ++j) {
      const double s = (i / 2 + 0.5 + (i % 2 ? gauss : -gauss)) / pieces - 0.5;
      const double t = (j / 2 + 0.5 + (j % 2 ? gauss : -gauss)) / pieces - 0.5;
      const double x = load.centre_x + s * load.size_x, y = load.centre_y + t * load.size_y;
      double xi = 0, eta = 0;
      std::size_t tried = 0;
      while (tried < faces.size() && !inside(body, *faces[last], x, y, xi, eta)) {
        last = (last + 1) % faces.size();
        ++tried;
      }
      if (tried == faces.size())
        throw InputError(text(name, ": load '", load.name,
                              "': its rectangle sticks out of boundary '", load.boundary, "' at x ",
                              x, ", y ", y, " m"));
      add(*faces[last], face_shape(faces[last]->count, xi, eta), share, weights);
    }
}

}  // namespace

LoadPatch load_patch(const Discretisation& body, const std::string& name, const Load& load) {
  const int id = find_boundary(body, name, "load '" + load.name + "'", load.boundary);
  Weights weights;
  if (load.rectangle)
    rectangle(body, id, name, load, weights);
  else
    whole_boundary(body, id, weights);
  LoadPatch patch;
  patch.direction = load.direction;
  const double size =
      std::sqrt(load.direction[0] * load.direction[0] + load.direction[1] * load.direction[1] +
                load.direction[2] * load.direction[2]);
  if (!(size > 0)) throw InputError(text(name, ": load '", load.name, "': its direction is zero"));
  for (double& d : patch.direction) d /= size;
  for (const auto& [node, weight] : weights)
    if (weight != 0) patch.weights.emplace_back(node, weight);
  return patch;
}

}  // namespace trackbed::fem
