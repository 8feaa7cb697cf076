#include "fem/reduction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/body_model.h"
#include "fem/frequencies.h"
#include "fem/linear_solver.h"
#include "fem/output.h"
#include "fem/supports.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

using Column = std::vector<double>;

constexpr int kLargestSurface = 1500;  // unknowns of a surface that is condensed

void check_damping(const BodyModel& b) {
  for (const Bed& bed : b.p.beds)
    if (bed.has_dashpots())
      throw InputError(text(b.p.name, ": dashpots on boundary '", bed.boundary,
                            "' couple the modes; a reduced body cannot have them, reduction none "
                            "can"));
  const Material& first = b.p.materials.front();
  for (const Material& m : b.p.materials)
    if (m.rayleigh_mass != first.rayleigh_mass || m.rayleigh_stiffness != first.rayleigh_stiffness)
      throw InputError(text(b.p.name, ": materials '", first.name, "' and '", m.name,
                            "' have different Rayleigh damping, which couples the modes; a reduced "
                            "body needs the same for all"));
}

// Modes of unit modal mass, built up vector by vector.
class Basis {
 public:
  explicit Basis(const Matrices& m) : m_(m) {}

  // Adds what is new in x (Gram–Schmidt with M, twice); almost nothing new is left out.
  void add(Column x) {
    Column mx;
    double size = norm(x, mx);
    if (!(size > 0)) return;
    for (double& c : x) c /= size;
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t k = 0; k < shape.size(); ++k) {
        const double share = dot(mass_shape_[k], x);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] -= share * shape[k][i];
      }
      size = norm(x, mx);
      if (size < 1e-7) return;  // round-off
      for (double& c : x) c /= size;
    }
    multiply(m_.pattern, m_.mass, x, mx);
    shape.push_back(std::move(x));
    mass_shape_.push_back(std::move(mx));
  }

  // f less what the first `rigid` vectors take up by their inertia: nothing that is free moves
  // away.
  Column balanced(Column f, int rigid) const {
    for (int k = 0; k < rigid; ++k) {
      const double share = dot(shape[k], f);
      for (std::size_t i = 0; i < f.size(); ++i) f[i] -= share * mass_shape_[k][i];
    }
    return f;
  }

  // Turns the vectors into the modes of their span; ω ascending.
  std::vector<double> diagonalise(double zero) {
    const int n = static_cast<int>(shape.size());
    Eigen::MatrixXd K(n, n);
    Column kx;
    for (int j = 0; j < n; ++j) {
      multiply(m_.pattern, m_.stiffness, shape[j], kx);
      for (int i = 0; i <= j; ++i) K(i, j) = K(j, i) = dot(shape[i], kx);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K);
    for (std::vector<Column>* vectors : {&shape, &mass_shape_}) {
      const std::size_t rows = shape.front().size();
      std::vector<Column> turned(n, Column(rows, 0.));
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const double share = solver.eigenvectors()(i, j);
          for (std::size_t r = 0; r < rows; ++r) turned[j][r] += share * (*vectors)[i][r];
        }
      *vectors = std::move(turned);
    }
    std::vector<double> omega;
    for (int j = 0; j < n; ++j) {
      const double w = std::sqrt(std::max(solver.eigenvalues()[j], 0.));
      omega.push_back(w < zero ? 0 : w);
    }
    return omega;
  }

  std::vector<Column> shape;

 private:
  double norm(const Column& x, Column& mx) const {
    multiply(m_.pattern, m_.mass, x, mx);
    return std::sqrt(std::max(dot(x, mx), 0.));
  }
  const Matrices& m_;
  std::vector<Column> mass_shape_;
};

// Forces of a pressure on a boundary: along direction d (0 … 2) or its normal (3), times `share` of
// the place within the boundary's box (−1 … 1 along each axis).
template <class Share>
Column pressure(const BodyModel& b, int boundary, int direction, Share&& share) {
  Vec low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Face& face : b.body.faces)
    if (face.boundary == boundary)
      for (int i = 0; i < face.count; ++i)
        for (int d = 0; d < 3; ++d) {
          low[d] = std::min(low[d], b.body.position[face.nodes[i]][d]);
          high[d] = std::max(high[d], b.body.position[face.nodes[i]][d]);
        }
  Column f(b.unknowns.count, 0.);
  for (const Face& face : b.body.faces) {
    if (face.boundary != boundary) continue;
    for (const FacePoint& point : face_points(b.body, face)) {
      Vec at{}, force{};
      for (int d = 0; d < 3; ++d)
        at[d] = high[d] > low[d] ? (2 * point.place[d] - low[d] - high[d]) / (high[d] - low[d]) : 0;
      for (int d = 0; d < 3; ++d) force[d] = direction < 3 ? d == direction : -point.normal[d];
      const double weight = share(at) * point.area;
      for (int i = 0; i < face.count; ++i) b.add(face.nodes[i], force, weight * point.shape[i], f);
    }
  }
  return f;
}

// Patterns that the static answer is to be right for.
std::vector<Column> load_patterns(const BodyModel& b, Reduction reduction) {
  std::vector<Column> patterns;
  const Column none(b.unknowns.count, 0.);
  for (const LoadPatch& patch : b.patches) {
    Column f = none;
    for (const auto& [node, weight] : patch.weights) b.add(node, patch.direction, weight, f);
    patterns.push_back(std::move(f));
  }
  if (b.has_gravity()) {
    Column f = none;
    b.outer_force(std::vector<double>(b.patches.size(), 0.), f);
    patterns.push_back(std::move(f));
  }
  if (reduction == Reduction::condensed) {
    std::vector<bool> taken(b.unknowns.count, false);
    for (const int node : b.surface.node)
      for (const int k : b.unknowns.of_node[node])
        if (k >= 0 && !taken[k]) {
          taken[k] = true;
          patterns.push_back(none);
          patterns.back()[k] = 1;
        }
    return patterns;
  }
  for (const std::string& name : b.p.contact) {
    const int boundary = b.body.boundaries.at(name);
    const auto even = [](const Vec&) { return 1.; };
    patterns.push_back(pressure(b, boundary, 3, even));
    for (int d = 0; d < 3; ++d) {
      patterns.push_back(pressure(b, boundary, 3, [d](const Vec& x) { return x[d]; }));
      patterns.push_back(pressure(b, boundary, d, even));
    }
  }
  return patterns;
}

// Work of a balanced force through the static deflection it makes: by the full factor, and by the
// modes that are not rigid.
struct Compliance {
  double full, reduced;
};

Compliance compliance(const Column& balanced, const Factor& factor, double shift, int rigid,
                      const std::vector<Column>& shape, const std::vector<double>& omega) {
  Column x(balanced.size());
  factor.solve(balanced, x);
  Compliance c{dot(balanced, x), 0};
  for (std::size_t k = rigid; k < shape.size(); ++k) {
    const double p = dot(shape[k], balanced);
    c.reduced += p * p / (omega[k] * omega[k] + shift);
  }
  return c;
}

int middle_node(const BodyModel& b, int boundary) {
  Vec centre{};
  double area = 0;
  for (const Face& face : b.body.faces)
    if (face.boundary == boundary)
      for (const FacePoint& p : face_points(b.body, face)) {
        for (int d = 0; d < 3; ++d) centre[d] += p.area * p.place[d];
        area += p.area;
      }
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : b.body.faces)
    if (face.boundary == boundary)
      for (int i = 0; i < face.count; ++i) {
        double distance = 0;
        for (int d = 0; d < 3; ++d)
          distance += std::pow(b.body.position[face.nodes[i]][d] - centre[d] / area, 2);
        if (distance < least - 1e-12) least = distance, best = face.nodes[i];
      }
  return best;
}

void fill(ReductionReport& r, const BodyModel& b, const Modes& normal, const Basis& basis,
          const std::vector<double>& omega, int rigid, const Factor& factor, double shift) {
  r.unknowns = b.unknowns.count;
  r.modes = static_cast<int>(omega.size());
  for (std::size_t k = rigid; k < normal.frequency.size() && r.frequencies.size() < 5; ++k) {
    const double reduced = omega[k] / (2 * M_PI);
    r.frequencies.emplace_back(normal.frequency[k], reduced);
    r.largest_frequency_error =
        std::max(r.largest_frequency_error, std::abs(reduced / normal.frequency[k] - 1));
  }
  for (const std::string& name : b.p.contact) {
    const int boundary = b.body.boundaries.at(name);
    const Column even = pressure(b, boundary, 3, [](const Vec&) { return 1.; });
    const int node = middle_node(b, boundary);
    Column dent(b.unknowns.count, 0.);
    for (const Face& face : b.body.faces)
      if (face.boundary == boundary &&
          std::count(face.nodes.begin(), face.nodes.begin() + face.count, node))
        b.add(node, face_points(b.body, face).front().normal, 1., dent);
    for (const auto& [force, error] :
         {std::pair{&even, &r.pressure_error}, {&dent, &r.node_error}}) {
      const Compliance c =
          compliance(basis.balanced(*force, rigid), factor, shift, rigid, basis.shape, omega);
      if (c.full > 0) *error = std::max(*error, 1 - c.reduced / c.full);
    }
  }
}

// Everything that moves as one: the fields of the whole body from modal coordinates.
Column whole(const std::vector<Column>& shape, const std::vector<double>& q) {
  Column u(shape.front().size(), 0.);
  for (std::size_t k = 0; k < q.size(); ++k)
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += q[k] * shape[k][i];
  return u;
}

ModalModel model_of(const std::shared_ptr<BodyModel>& body, std::vector<Column> shape,
                    std::vector<double> omega, bool held) {
  const BodyModel& b = *body;
  const int n = static_cast<int>(omega.size());
  ModalModel m;
  m.name = b.p.name;
  m.surface = b.surface.mesh;
  m.omega = std::move(omega);
  m.damping_mass = b.p.materials.front().rayleigh_mass;
  m.damping_stiffness = b.p.materials.front().rayleigh_stiffness;
  m.shape.resize(3 * b.surface.node.size() * n);
  for (int k = 0; k < n; ++k)
    for (std::size_t i = 0; i < b.surface.node.size(); ++i) {
      const Vec u = b.at(shape[k], b.surface.node[i]);
      for (int d = 0; d < 3; ++d) m.shape[(3 * i + d) * n + k] = u[d];
    }
  for (std::size_t l = 0; l < b.patches.size(); ++l) {
    ModalLoad load{b.p.loads[l].name, b.patches[l].direction, std::vector<double>(3 * n)};
    for (int k = 0; k < n; ++k) {
      const Vec mean = b.patch_mean(static_cast<int>(l), shape[k]);
      for (int d = 0; d < 3; ++d) load.shape[d * n + k] = mean[d];
    }
    m.loads.push_back(std::move(load));
  }
  if (b.has_gravity()) {
    Column f(b.unknowns.count);
    b.outer_force(std::vector<double>(b.patches.size(), 0.), f);
    for (int k = 0; k < n; ++k) m.gravity.push_back(dot(shape[k], f));
  }
  m.start_in_equilibrium = b.p.start_in_equilibrium && held;
  m.mass = b.mass();
  m.least_surface_mass = b.least_surface_mass();
  m.write = [body, shape = std::move(shape)](const std::string& file, const std::vector<double>& q,
                                             const std::vector<double>& v) {
    write_fields(file, body->p, body->grid, body->body, body->everywhere(whole(shape, q)),
                 body->everywhere(whole(shape, v)));
  };
  return m;
}

}  // namespace

Reduction reduction_of(const std::string& name) {
  return name == "condensed" ? Reduction::condensed
         : name == "modal"   ? Reduction::modal
                             : Reduction::none;
}

std::unique_ptr<ModalStructure> reduced_body(ElasticBodyParameters parameters, Reduction reduction,
                                             int modes) {
  if (reduction == Reduction::none)
    throw InputError(parameters.name + ": reduction none has no reduced body");
  const auto body = std::make_shared<BodyModel>(std::move(parameters));
  const BodyModel& b = *body;
  check_damping(b);
  const Matrices& m = b.matrices();
  const double largest = largest_frequency(m), zero = 1e-6 * largest;
  const bool held = b.free_motion().empty();
  const int wanted = std::min(b.unknowns.count, std::max(1, modes) + (held ? 0 : 6));
  const std::vector<Column> patterns = load_patterns(b, reduction);
  if (reduction == Reduction::condensed && patterns.size() > kLargestSurface)
    throw InputError(text(b.p.name, ": its contact surface has ", patterns.size(),
                          " unknowns, at most ", kLargestSurface,
                          " are condensed; use reduction modal"));

  const Modes normal = lowest_modes(m, wanted);
  int rigid = 0;
  while (rigid < wanted && 2 * M_PI * normal.frequency[rigid] < zero) ++rigid;
  if (rigid == wanted) throw InputError(b.p.name + ": modes: more are needed than rigid motions");

  // A little mass holds what supports do not; the low modes it touches are in the basis.
  const double first = 2 * M_PI * normal.frequency[rigid];
  const double shift = rigid > 0 ? 1e-4 * first * first : 0;
  std::vector<double> shifted = m.stiffness;
  for (std::size_t e = 0; e < shifted.size(); ++e) shifted[e] += shift * m.mass[e];
  const Factor factor(m.pattern, shifted, b.p.name.c_str());

  Basis basis(m);
  for (const Column& x : normal.shape) basis.add(x);
  Column x(b.unknowns.count);
  for (const Column& f : patterns) {
    factor.solve(basis.balanced(f, rigid), x);
    basis.add(x);
  }
  const std::vector<double> omega = basis.diagonalise(zero);
  auto report = std::make_shared<ReductionReport>();
  fill(*report, b, normal, basis, omega, rigid, factor, shift);
  ModalModel model = model_of(body, std::move(basis.shape), omega, held);
  model.report = std::move(report);
  return std::make_unique<ModalStructure>(std::move(model));
}

}  // namespace trackbed::fem
