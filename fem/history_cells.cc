#include "fem/history_cells.h"

#include <algorithm>

#include "base/error.h"
#include "fem/discretisation.h"

namespace trackbed::fem {

ElasticBodyParameters history_parameters(ElasticBodyParameters p, double density) {
  if (!p.beds.empty())
    throw InputError(p.name + ": absorbing boundaries need an elastic material; none is allowed");
  Material m;
  m.name = "of the stress model";
  m.young = 1, m.poisson = 0, m.density = density;
  p.materials = {m};
  for (Layer& layer : p.mesh.layers) layer.material = 0;
  p.loads.clear();
  p.gravity = {0, 0, 0};
  p.mass = Mass::lumped;
  return p;
}

std::vector<int> cell_unknowns(const Discretisation& body, const Unknowns& unknowns,
                               const std::vector<int>& cells) {
  const int n = body.nodes_per_cell;
  std::vector<int> all;
  for (const int c : cells)
    for (int a = 0; a < n; ++a)
      for (const int id : unknowns.of_node[body.cell_nodes[c * n + a]]) all.push_back(id);
  return all;
}

HistoryCells::HistoryCells(const Grid& grid, int order, std::shared_ptr<const StressModel> model,
                           std::vector<int> cells, std::vector<int> place, std::vector<char> own)
    : points_(cell_points(grid, order, cells)),
      model_(std::move(model)),
      cells_(std::move(cells)),
      place_(std::move(place)),
      own_(std::move(own)),
      remembered_(static_cast<std::size_t>(points_.points) * model_->history()) {
  const int q = points_.points;
  history_.assign(remembered_ * points_.cells, 0.);
  next_ = history_;
  in_.strain.resize(q), out_.stress.resize(q), out_.stored.resize(q), out_.dissipated.resize(q);
  out_.history.resize(remembered_);
  B_.resize(q);
  displacement_.resize(3l * points_.nodes);
}

void HistoryCells::find_stress(int k, const std::vector<double>& u, bool want_tangent) {
  const int n3 = 3 * points_.nodes, q = points_.points;
  const int* place = &place_[static_cast<std::size_t>(k) * n3];
  for (int j = 0; j < n3; ++j) displacement_[j] = place[j] < 0 ? 0. : u[place[j]];
  in_.depth.assign(&points_.depth[k * q], &points_.depth[k * q] + q);
  const auto first = history_.begin() + static_cast<std::ptrdiff_t>(k * remembered_);
  in_.history.assign(first, first + static_cast<std::ptrdiff_t>(remembered_));
  for (int p = 0; p < q; ++p) {
    strain_matrix(points_, k, p, B_[p]);
    for (int i = 0; i < 6; ++i) {
      double sum = 0;
      for (int j = 0; j < n3; ++j) sum += B_[p][n3 * i + j] * displacement_[j];
      in_.strain[p][i] = sum;
    }
  }
  out_.want_tangent = want_tangent;
  out_.tangent.resize(want_tangent ? q : 0);
  model_->evaluate(in_, out_);
}

void HistoryCells::evaluate(const std::vector<double>& u, std::vector<double>& force,
                            const AddTangent& add) {
  const int n3 = 3 * points_.nodes, q = points_.points, count = static_cast<int>(force.size());
  stored_ = dissipated_ = 0;
  for (int k = 0; k < points_.cells; ++k) {
    find_stress(k, u, static_cast<bool>(add));
    std::copy(out_.history.begin(), out_.history.end(),
              next_.begin() + static_cast<std::ptrdiff_t>(k * remembered_));
    force_.assign(n3, 0.);
    if (add) stiffness_.assign(static_cast<std::size_t>(n3) * n3, 0.);
    for (int p = 0; p < q; ++p) {
      const double w = points_.weight[k * q + p];
      if (own_[k]) {
        stored_ += w * out_.stored[p];
        dissipated_ += w * out_.dissipated[p];
      }
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < n3; ++j) force_[j] += w * B_[p][n3 * i + j] * out_.stress[p][i];
      if (add) add_tangent(out_.tangent[p], w, B_[p]);
    }
    const int* place = &place_[static_cast<std::size_t>(k) * n3];
    for (int j = 0; j < n3; ++j)
      if (place[j] >= 0 && place[j] < count) force[place[j]] += force_[j];
    if (add) add(place, stiffness_);
  }
}

// K += w Bᵀ D B
void HistoryCells::add_tangent(const Tangent& D, double w, const std::vector<double>& B) {
  const int n3 = 3 * points_.nodes;
  weighted_.resize(6l * n3);  // w D B
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < n3; ++j) {
      double sum = 0;
      for (int l = 0; l < 6; ++l) sum += D[6 * i + l] * B[n3 * l + j];
      weighted_[n3 * i + j] = w * sum;
    }
  for (int j = 0; j < n3; ++j)
    for (int i = 0; i < 6; ++i) {
      const double b = B[n3 * i + j];
      if (b == 0) continue;
      for (int l = 0; l < n3; ++l) stiffness_[n3 * j + l] += b * weighted_[n3 * i + l];
    }
}

std::vector<Voigt> HistoryCells::mean_stress(const std::vector<double>& u) {
  std::vector<Voigt> mean(points_.cells, Voigt{});
  for (int k = 0; k < points_.cells; ++k) {
    find_stress(k, u, false);
    double volume = 0;
    for (int p = 0; p < points_.points; ++p) {
      const double w = points_.weight[k * points_.points + p];
      volume += w;
      for (int i = 0; i < 6; ++i) mean[k][i] += w * out_.stress[p][i];
    }
    for (double& component : mean[k]) component /= volume;
  }
  return mean;
}

}  // namespace trackbed::fem
