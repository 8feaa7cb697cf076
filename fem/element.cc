#include "fem/element.h"

#include "base/error.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

const auto kUpdate = dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                     dealii::update_jacobians | dealii::update_quadrature_points;

double highest(const Grid& grid) {
  double top = -std::numeric_limits<double>::infinity();
  for (const auto& x : grid.cells.get_vertices()) top = std::max(top, x[2]);
  return top;
}

}  // namespace

RayleighDamping rayleigh_damping(double ratio, double low, double high) {
  return {2 * ratio * low * high / (low + high), 2 * ratio / (low + high)};
}

std::vector<std::shared_ptr<const MaterialModel>> models_of(const ElasticBodyParameters& p) {
  if (p.materials.empty()) throw InputError(p.name + ": no material given");
  std::vector<std::shared_ptr<const MaterialModel>> models;
  for (const Material& m : p.materials) {
    const std::string name = text(p.name, ": material '", m.name, "'");
    if (!(m.rayleigh_mass >= 0) || !(m.rayleigh_stiffness >= 0))
      throw InputError(text(name, ": Rayleigh damping ", m.rayleigh_mass, " 1/s, ",
                            m.rayleigh_stiffness, " s, must be 0 or more"));
    models.push_back(m.model ? m.model
                             : uniform_elastic(name.c_str(), m.young, m.poisson, m.density));
  }
  return models;
}

ElementIntegrals::ElementIntegrals(const ElasticBodyParameters& p, const Grid& grid)
    : models_(models_of(p)),
      element_(p.order == 2 && p.element == Element::incompatible ? Element::standard : p.element),
      top_(highest(grid)),
      values_(grid.shape, dealii::QGauss<3>(p.order + 1), kUpdate),
      centre_(grid.shape, dealii::QMidpoint<3>(), kUpdate) {
  const unsigned n = grid.shape.n_dofs_per_cell();
  stiffness.reinit(3 * n, 3 * n);
  mass.reinit(n, n);
  if (element_ == Element::incompatible) {
    full_.reinit(3 * n + 9, 3 * n + 9);
    inner_.reinit(9, 9);
    coupling_.reinit(9, 3 * n);
    product_.reinit(9, 3 * n);
  }
}

void ElementIntegrals::evaluate_material(const Cell& cell, const dealii::FEValues<3>& values) {
  const unsigned points = values.n_quadrature_points;
  in_.points.resize(points);
  in_.depth.resize(points);
  for (auto* field : {&out_.young, &out_.poisson, &out_.density}) field->assign(points, kMustBeSet);
  for (unsigned q = 0; q < points; ++q) {
    const auto& x = values.quadrature_point(q);
    in_.points[q] = {x[0], x[1], x[2]};
    in_.depth[q] = top_ - x[2];
  }
  models_[cell->material_id()]->evaluate(in_, out_);
}

// Gradients whose divergence is projected, in L² over the cell, on constants (order 1) or on linear
// functions (order 2).
void ElementIntegrals::project_dilatation() {
  const unsigned n = values_.dofs_per_cell, points = values_.n_quadrature_points;
  const unsigned m = n == 8 ? 1 : 4;
  const auto origin = values_.quadrature_point(points / 2);
  const auto basis = [&](unsigned k, unsigned q) {
    return k == 0 ? 1. : (values_.quadrature_point(q) - origin)[k - 1];
  };
  dealii::FullMatrix<double> gram(m, m);
  std::vector<dealii::Tensor<1, 3>> moments(m * n);
  for (unsigned q = 0; q < points; ++q)
    for (unsigned k = 0; k < m; ++k) {
      const double w = basis(k, q) * values_.JxW(q);
      for (unsigned l = 0; l < m; ++l) gram(k, l) += w * basis(l, q);
      for (unsigned a = 0; a < n; ++a) moments[k * n + a] += w * values_.shape_grad(a, q);
    }
  gram.gauss_jordan();
  dilatation_.assign(points * n, {});
  for (unsigned q = 0; q < points; ++q)
    for (unsigned k = 0; k < m; ++k)
      for (unsigned l = 0; l < m; ++l)
        for (unsigned a = 0; a < n; ++a)
          dilatation_[q * n + a] += basis(k, q) * gram(k, l) * moments[l * n + a];
}

void ElementIntegrals::compute(const Cell& cell) {
  values_.reinit(cell);
  evaluate_material(cell, values_);
  const unsigned n = values_.dofs_per_cell, points = values_.n_quadrature_points;
  const bool modes = element_ == Element::incompatible, mean = element_ == Element::b_bar;
  const unsigned functions = n + (modes ? 3 : 0);
  dealii::FullMatrix<double>& K = modes ? full_ : stiffness;
  K = 0;
  mass = 0;

  std::vector<dealii::Tensor<1, 3>> gradient(functions);
  dealii::Tensor<2, 3> to_cell;
  double centre_det = 0;
  if (modes) {
    centre_.reinit(cell);
    const dealii::Tensor<2, 3> J(centre_.jacobian(0));
    centre_det = determinant(J);
    to_cell = invert(transpose(J));
  }
  if (mean) project_dilatation();

  for (unsigned q = 0; q < points; ++q) {
    const double E = out_.young[q], nu = out_.poisson[q], w = values_.JxW(q);
    const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    for (unsigned a = 0; a < n; ++a) gradient[a] = values_.shape_grad(a, q);
    if (modes) {
      const double scale = centre_det / determinant(dealii::Tensor<2, 3>(values_.jacobian(q)));
      const auto& unit = values_.get_quadrature().point(q);
      for (unsigned m = 0; m < 3; ++m)
        for (unsigned d = 0; d < 3; ++d)
          gradient[n + m][d] = scale * to_cell[d][m] * 4 * (1 - 2 * unit[m]);
    }
    // Deviatoric and volumetric part apart for the mean dilatation, else as one.
    const double volumetric = mean ? -2 * mu / 3 : lambda;
    const double bulk = lambda + 2 * mu / 3;
    for (unsigned a = 0; a < functions; ++a)
      for (unsigned b = 0; b < functions; ++b) {
        const double both = mu * w * (gradient[a] * gradient[b]);
        for (unsigned i = 0; i < 3; ++i) {
          for (unsigned j = 0; j < 3; ++j) {
            double k =
                volumetric * gradient[a][i] * gradient[b][j] + mu * gradient[a][j] * gradient[b][i];
            if (mean) k += bulk * dilatation_[q * n + a][i] * dilatation_[q * n + b][j];
            K(3 * a + i, 3 * b + j) += k * w;
          }
          K(3 * a + i, 3 * b + i) += both;
        }
      }
    for (unsigned a = 0; a < n; ++a)
      for (unsigned b = 0; b < n; ++b)
        mass(a, b) += out_.density[q] * w * values_.shape_value(a, q) * values_.shape_value(b, q);
  }

  if (modes) {  // K_uu − K_ua K_aa⁻¹ K_au
    for (unsigned i = 0; i < 9; ++i) {
      for (unsigned j = 0; j < 9; ++j) inner_(i, j) = full_(3 * n + i, 3 * n + j);
      for (unsigned j = 0; j < 3 * n; ++j) coupling_(i, j) = full_(3 * n + i, j);
    }
    inner_.gauss_jordan();
    inner_.mmult(product_, coupling_);
    coupling_.Tmmult(stiffness, product_);
    for (unsigned i = 0; i < 3 * n; ++i)
      for (unsigned j = 0; j < 3 * n; ++j) stiffness(i, j) = full_(i, j) - stiffness(i, j);
  }
}

std::array<double, 6> ElementIntegrals::centre_stress(const Cell& cell,
                                                      const std::vector<Vec>& displacement) {
  centre_.reinit(cell);
  evaluate_material(cell, centre_);
  dealii::Tensor<2, 3> slope;
  for (unsigned a = 0; a < centre_.dofs_per_cell; ++a)
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned j = 0; j < 3; ++j)
        slope[i][j] += displacement[a][i] * centre_.shape_grad(a, 0)[j];
  const double E = out_.young[0], nu = out_.poisson[0];
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const double pressure = lambda * trace(slope);
  return {pressure + 2 * mu * slope[0][0],  pressure + 2 * mu * slope[1][1],
          pressure + 2 * mu * slope[2][2],  mu * (slope[1][2] + slope[2][1]),
          mu * (slope[0][2] + slope[2][0]), mu * (slope[0][1] + slope[1][0])};
}

std::array<double, 3> ElementIntegrals::mean_elastic() const {
  std::array<double, 3> mean{};
  const double share = 1. / static_cast<double>(out_.young.size());
  for (std::size_t q = 0; q < out_.young.size(); ++q) {
    mean[0] += share * out_.young[q];
    mean[1] += share * out_.poisson[q];
    mean[2] += share * out_.density[q];
  }
  return mean;
}

}  // namespace trackbed::fem
