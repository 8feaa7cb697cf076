#include "fem/beam.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "fem/materials/model.h"
#include "fem/surface.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Row = Eigen::Matrix<double, 1, 12>;  // of an element: six motions of each of its two nodes

struct Section {
  double EA, GJ, EIy, EIz, GA;        // y: vertical bending (about y), z: sideways (about z)
  double mass, inertia_y, inertia_z;  // per length
};

Section section_of(const BeamParameters& p) {
  const double b = p.width, h = p.height, E = p.young, G = E / (2 * (1 + p.poisson));
  const double longer = std::max(b, h), shorter = std::min(b, h), r = shorter / longer;
  const double torsion =
      longer * std::pow(shorter, 3) * (1. / 3 - 0.21 * r * (1 - std::pow(r, 4) / 12));
  Section s{};
  s.EA = E * b * h;
  s.GJ = G * torsion;
  s.EIy = p.bending > 0 ? p.bending : E * b * h * h * h / 12;
  s.EIz = E * h * b * b * b / 12;
  s.GA = p.shear_factor * G * b * h;
  if (p.shear_rigid) s.GA *= 1e9;
  s.mass = p.density * b * h;
  s.inertia_y = p.density * b * h * h * h / 12;
  s.inertia_z = p.density * h * b * b * b / 12;
  return s;
}

// What moves at ξ = x/L of an element, as rows of its twelve motions.
struct Kinematics {
  Row ux, uy, uz, tx, ty, tz;          // displacement and turn of the line
  Row stretch, twist, bend_y, bend_z;  // their slopes
  Row shear_y, shear_z;                // in the x-z and the x-y plane
};

// Bending in one plane: w and ψ of (w1, ψ1, w2, ψ2), φ = 12 EI/(GA L²).
struct Bending {
  std::array<double, 4> w, psi, slope_w, slope_psi;
};

Bending bending(double t, double L, double phi) {
  const double c = 1 / (1 + phi);
  Bending b;
  b.w = {c * (1 - 3 * t * t + 2 * t * t * t + phi * (1 - t)),
         c * L * (t - 2 * t * t + t * t * t + phi / 2 * (t - t * t)),
         c * (3 * t * t - 2 * t * t * t + phi * t),
         c * L * (-t * t + t * t * t - phi / 2 * (t - t * t))};
  b.slope_w = {c / L * (-6 * t + 6 * t * t - phi),
               c * (1 - 4 * t + 3 * t * t + phi / 2 * (1 - 2 * t)),
               c / L * (6 * t - 6 * t * t + phi), c * (-2 * t + 3 * t * t - phi / 2 * (1 - 2 * t))};
  b.psi = {c * 6 / L * (t * t - t), c * (1 - 4 * t + 3 * t * t + phi * (1 - t)),
           c * 6 / L * (t - t * t), c * (3 * t * t - 2 * t + phi * t)};
  b.slope_psi = {c * 6 / L / L * (2 * t - 1), c / L * (6 * t - 4 - phi),
                 c * 6 / L / L * (1 - 2 * t), c / L * (6 * t - 2 + phi)};
  return b;
}

Kinematics kinematics(double t, double L, const Section& s) {
  Kinematics k;
  for (Row* r : {&k.ux, &k.uy, &k.uz, &k.tx, &k.ty, &k.tz, &k.stretch, &k.twist, &k.bend_y,
                 &k.bend_z, &k.shear_y, &k.shear_z})
    r->setZero();
  const double linear[2] = {1 - t, t}, slope[2] = {-1 / L, 1 / L};
  const Bending vertical = bending(t, L, 12 * s.EIy / (s.GA * L * L));
  const Bending sideways = bending(t, L, 12 * s.EIz / (s.GA * L * L));
  for (int n = 0; n < 2; ++n) {
    const int at = 6 * n;
    k.ux[at] = linear[n], k.stretch[at] = slope[n];
    k.tx[at + 3] = linear[n], k.twist[at + 3] = slope[n];
    for (int j = 0; j < 2; ++j) {  // w and ψ; a turn about y lowers the beam ahead: ψ = −θy
      const int i = 2 * n + j, v = j ? at + 4 : at + 2, h = j ? at + 5 : at + 1;
      const double sign = j ? -1 : 1;
      k.uz[v] = sign * vertical.w[i];
      k.ty[v] = -sign * vertical.psi[i];
      k.bend_y[v] = sign * vertical.slope_psi[i];
      k.shear_y[v] = sign * (vertical.slope_w[i] - vertical.psi[i]);
      k.uy[h] = sideways.w[i];
      k.tz[h] = sideways.psi[i];
      k.bend_z[h] = sideways.slope_psi[i];
      k.shear_z[h] = sideways.slope_w[i] - sideways.psi[i];
    }
  }
  return k;
}

// Gauss with four points on (0, 1): exact to order 7, the mass needs 6.
constexpr double kPoint[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                              0.93056815579702629};
constexpr double kWeight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                               0.17392742256872693};

void check(const BeamParameters& p) {
  check_elastic(p.name.c_str(), p.young, p.poisson, p.density);
  if (!(p.high_x > p.low_x))
    throw InputError(text(p.name, ": length ", p.high_x - p.low_x, " m, must be positive"));
  if (!(p.width > 0) || !(p.height > 0))
    throw InputError(
        text(p.name, ": section ", p.width, " x ", p.height, " m, both must be positive"));
  if (p.elements < 1 || p.cells_y < 1 || p.cells_z < 1)
    throw InputError(p.name + ": elements: one or more are needed along each axis");
  for (const BeamLoad& l : p.loads)
    if (l.centre - l.length / 2 < p.low_x - 1e-9 || l.centre + l.length / 2 > p.high_x + 1e-9)
      throw InputError(text(p.name, ": load '", l.name, "' at x = ", l.centre, " m, ", l.length,
                            " m long, sticks out of the beam, which ends at ", p.high_x, " m"));
}

// Motion of the line at x as rows over all motions of the beam.
struct Line {
  const BeamParameters& p;
  Section section;
  double L;

  template <class Use>
  void at(double x, Use&& use) const {  // use(first motion of the element, kinematics)
    const int e = std::clamp(static_cast<int>((x - p.low_x) / L), 0, p.elements - 1);
    use(6 * e, kinematics((x - p.low_x) / L - e, L, section));
  }
};

// Displacement of the point at (x, y, z) from the line's middle: three rows of `motions`.
Eigen::Matrix<double, 3, 12> point_rows(const Kinematics& k, double y, double z) {
  Eigen::Matrix<double, 3, 12> u;
  u.row(0) = k.ux + z * k.ty - y * k.tz;
  u.row(1) = k.uy - z * k.tx;
  u.row(2) = k.uz + y * k.tx;
  return u;
}

// Quads of the prism: rings of nodes at the stations, and the two ends.
struct Prism {
  SurfaceMesh mesh;
  std::vector<Vec> offset;  // of each node: station x, y and z from the line
};

Prism prism(const BeamParameters& p) {
  Prism out;
  const int nx = p.elements, ny = p.cells_y, nz = p.cells_z;
  std::vector<int> number((nx + 1) * (ny + 1) * (nz + 1), -1);
  const auto node = [&](int i, int j, int k) {
    int& id = number[(i * (ny + 1) + j) * (nz + 1) + k];
    if (id < 0) {
      id = static_cast<int>(out.offset.size());
      const double x = p.low_x + (p.high_x - p.low_x) * i / nx;
      const double y = p.width * (static_cast<double>(j) / ny - 0.5);
      const double z = p.height * (static_cast<double>(k) / nz - 0.5);
      out.offset.push_back({x, y, z});
      out.mesh.nodes.push_back({x, y, p.base + p.height / 2 + z});
      out.mesh.same_as.push_back(id);
    }
    return id;
  };
  const auto quad = [&](int a, int b, int c, int d, int boundary) {
    out.mesh.quads.push_back({a, b, c, d});
    out.mesh.boundary.push_back(boundary);
  };
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      quad(node(i, j, 0), node(i, j + 1, 0), node(i + 1, j + 1, 0), node(i + 1, j, 0), 0);
      quad(node(i, j, nz), node(i + 1, j, nz), node(i + 1, j + 1, nz), node(i, j + 1, nz), 1);
    }
    for (int k = 0; k < nz; ++k) {
      quad(node(i, 0, k), node(i + 1, 0, k), node(i + 1, 0, k + 1), node(i, 0, k + 1), 2);
      quad(node(i, ny, k), node(i, ny, k + 1), node(i + 1, ny, k + 1), node(i + 1, ny, k), 3);
    }
  }
  for (int j = 0; j < ny; ++j)
    for (int k = 0; k < nz; ++k) {
      quad(node(nx, j, k), node(nx, j + 1, k), node(nx, j + 1, k + 1), node(nx, j, k + 1), 4);
      if (!p.half)
        quad(node(0, j, k), node(0, j, k + 1), node(0, j + 1, k + 1), node(0, j + 1, k), 5);
    }
  mark_edges(out.mesh);
  return out;
}

// Modes of unit modal mass of the motions that are free; ω = 0 exactly for rigid ones.
struct BeamModes {
  MatrixXd shape;  // a column a mode, all motions
  std::vector<double> omega;
};

BeamModes modes_of(const MatrixXd& K, const MatrixXd& M, const std::vector<int>& free,
                   const MatrixXd& rigid) {
  const int n = static_cast<int>(free.size());
  MatrixXd k(n, n), m(n, n), r(n, rigid.cols());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) k(i, j) = K(free[i], free[j]), m(i, j) = M(free[i], free[j]);
    r.row(i) = rigid.row(free[i]);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(k, m);
  MatrixXd shape = solver.eigenvectors();
  const double most = solver.eigenvalues()[n - 1];
  BeamModes out;
  for (int i = 0; i < n; ++i) {
    const double w2 = solver.eigenvalues()[i];
    out.omega.push_back(w2 > 1e-12 * most ? std::sqrt(w2) : 0);
  }
  // Rigid motions as they are, not as the solver rounds them; the others orthogonal to them.
  const int zero = static_cast<int>(std::count(out.omega.begin(), out.omega.end(), 0.));
  int taken = 0;
  for (int c = 0; c < r.cols() && taken < zero; ++c) {
    VectorXd x = r.col(c);
    if (x.norm() == 0 || (k * x).norm() > 1e-9 * k.norm() * x.norm()) continue;
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < taken; ++j) x -= shape.col(j).dot(m * x) * shape.col(j);
    const double size = std::sqrt(x.dot(m * x));
    if (size < 1e-9 * std::sqrt(m.norm()) * r.col(c).norm()) continue;
    shape.col(taken++) = x / size;
  }
  for (int i = zero; i < n; ++i)
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < taken; ++j)
        shape.col(i) -= shape.col(j).dot(m * shape.col(i)) * shape.col(j);
  out.shape = MatrixXd::Zero(K.rows(), n);
  for (int i = 0; i < n; ++i) out.shape.row(free[i]) = shape.row(i);
  return out;
}

}  // namespace

std::unique_ptr<ModalStructure> make_beam(const BeamParameters& p) {
  check(p);
  const Line line{p, section_of(p), (p.high_x - p.low_x) / p.elements};
  const Section& s = line.section;
  const int motions = 6 * (p.elements + 1);
  MatrixXd K = MatrixXd::Zero(motions, motions), M = K;
  VectorXd weight = VectorXd::Zero(motions);
  for (int e = 0; e < p.elements; ++e)
    for (int g = 0; g < 4; ++g) {
      const Kinematics k = kinematics(kPoint[g], line.L, s);
      const double w = kWeight[g] * line.L;
      auto Ke = K.block<12, 12>(6 * e, 6 * e);
      auto Me = M.block<12, 12>(6 * e, 6 * e);
      const auto add = [&](auto& to, double factor, const Row& r) {
        to += w * factor * r.transpose() * r;
      };
      add(Ke, s.EA, k.stretch), add(Ke, s.GJ, k.twist);
      add(Ke, s.EIy, k.bend_y), add(Ke, s.EIz, k.bend_z);
      add(Ke, s.GA, k.shear_y), add(Ke, s.GA, k.shear_z);
      add(Ke, p.bed, k.uz);
      add(Me, s.mass, k.ux), add(Me, s.mass, k.uy), add(Me, s.mass, k.uz);
      add(Me, s.inertia_y + s.inertia_z, k.tx), add(Me, s.inertia_y, k.ty),
          add(Me, s.inertia_z, k.tz);
      weight.segment<12>(6 * e) +=
          w * s.mass *
          (p.gravity[0] * k.ux + p.gravity[1] * k.uy + p.gravity[2] * k.uz).transpose();
    }
  // On a plane of symmetry: no motion along x, no turn about y and z.
  std::vector<int> free;
  for (int i = 0; i < motions; ++i) {
    const bool plane = p.half && (i == 0 || i == 4 || i == 5);
    const bool held = p.supported && (i == motions - 4 || (i == 2 && !p.half));
    if (!plane && !held) free.push_back(i);
  }
  MatrixXd rigid = MatrixXd::Zero(motions, 6);
  const double middle = (p.low_x + p.high_x) / 2;
  for (int i = 0; i <= p.elements; ++i) {
    const double x = p.low_x + i * line.L - middle;
    for (int d = 0; d < 6; ++d) rigid(6 * i + d, d) = 1;
    rigid(6 * i + 2, 4) = -x;
    rigid(6 * i + 1, 5) = x;
  }
  const BeamModes modes = modes_of(K, M, free, rigid);
  const int n = static_cast<int>(modes.omega.size());

  ModalModel model;
  model.name = p.name;
  model.omega = modes.omega;
  Prism surface = prism(p);
  for (const Vec& at : surface.offset)
    line.at(at[0], [&](int first, const Kinematics& k) {
      const MatrixXd u = point_rows(k, at[1], at[2]) * modes.shape.middleRows<12>(first);
      for (int d = 0; d < 3; ++d)
        for (int i = 0; i < n; ++i) model.shape.push_back(u(d, i));
    });
  for (const BeamLoad& l : p.loads) {
    MatrixXd mean = MatrixXd::Zero(3, n);
    const int pieces = l.length > 0 ? 64 : 1;
    for (int i = 0; i < pieces; ++i)
      line.at(l.centre + l.length * ((i + 0.5) / pieces - 0.5),
              [&](int first, const Kinematics& k) {
                mean += point_rows(k, 0, p.height / 2) * modes.shape.middleRows<12>(first) / pieces;
              });
    ModalLoad load{l.name, l.direction, {}};
    for (int d = 0; d < 3; ++d)
      for (int i = 0; i < n; ++i) load.shape.push_back(mean(d, i));
    model.loads.push_back(std::move(load));
  }
  const VectorXd modal_weight = modes.shape.transpose() * weight;
  if (weight.norm() > 0) model.gravity.assign(modal_weight.data(), modal_weight.data() + n);
  for (int i = 0; i <= p.elements; ++i) {
    ModalGauge gauge{text("moment at x = ", p.low_x + i * line.L, " m"), {}};
    line.at(p.low_x + i * line.L, [&](int first, const Kinematics& k) {
      const VectorXd row = (s.EIy * k.bend_y * modes.shape.middleRows<12>(first)).transpose();
      gauge.shape.assign(row.data(), row.data() + n);
    });
    model.gauges.push_back(std::move(gauge));
  }
  model.mass = s.mass * (p.high_x - p.low_x);
  // A quarter of a node's share of its ring: contacts at a section's corner also turn it.
  model.least_surface_mass = s.mass * line.L / 2 / (2 * (p.cells_y + p.cells_z)) / 4;
  model.surface = std::move(surface.mesh);
  return std::make_unique<ModalStructure>(std::move(model));
}

}  // namespace trackbed::fem
