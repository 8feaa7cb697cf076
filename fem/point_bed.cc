#include "fem/point_bed.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/text.h"
#include "fem/time_integration.h"

namespace trackbed::fem {
namespace {

class PointBed final : public Structure {
 public:
  explicit PointBed(const PointBedParameters& p)
      : p_(p), scheme_(p.newmark ? newmark() : generalised_alpha(p.rho_inf)) {
    const auto require = [](bool good, const char* what, double value, const char* allowed) {
      if (!good) throw InputError(text("Subgrade: ", what, " ", value, ", must be ", allowed));
    };
    require(p.stiffness > 0, "stiffness [N/m3]", p.stiffness, "positive");
    require(p.mass > 0, "mass [kg/m2]", p.mass, "positive");
    require(p.dashpot >= 0, "dashpot [N s/m3]", p.dashpot, "0 or more");
    require(p.cells_x > 0 && p.cells_y > 0, "cells", std::min(p.cells_x, p.cells_y), "1 or more");
    require(p.x_high > p.x_low && p.y_high > p.y_low, "plan", p.x_high - p.x_low, "positive");
    const int nx = p.cells_x + 1, ny = p.cells_y + 1;
    const double hx = (p.x_high - p.x_low) / p.cells_x, hy = (p.y_high - p.y_low) / p.cells_y;
    const auto id = [&](int i, int j) { return j * nx + i; };
    area_.assign(nx * ny, 0.);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        surface_.nodes.push_back({p.x_low + i * hx, p.y_low + j * hy, p.top});
        surface_.same_as.push_back(
            id(p.periodic_x && i == p.cells_x ? 0 : i, p.periodic_y && j == p.cells_y ? 0 : j));
      }
    const auto rim = [](bool at_rim, bool periodic) {
      return !at_rim ? Edge::inner : periodic ? Edge::seam : Edge::border;
    };
    for (int j = 0; j < p.cells_y; ++j)
      for (int i = 0; i < p.cells_x; ++i) {
        surface_.quads.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
        surface_.edges.push_back({rim(j == 0, p.periodic_y), rim(i + 1 == p.cells_x, p.periodic_x),
                                  rim(j + 1 == p.cells_y, p.periodic_y),
                                  rim(i == 0, p.periodic_x)});
        surface_.boundary.push_back(0);
        for (int node : surface_.quads.back()) area_[surface_.same_as[node]] += hx * hy / 4;
      }
    surface_.period = {p.periodic_x ? p.x_high - p.x_low : 0, p.periodic_y ? p.y_high - p.y_low : 0,
                       0};
    for (auto* field : {&s_.u, &s_.v, &s_.a, &s_.f, &force_}) field->assign(area_.size(), 0.);
  }

  const SurfaceMesh& surface() const override { return surface_; }

  void set_step(double dt) override {
    if (!(dt > 0) || !std::isfinite(dt))
      throw InputError(text("time step of the subgrade: ", dt, " s given, must be positive"));
    dt_ = dt;
  }

  void predict(std::vector<Vec>& u, std::vector<Vec>& v) const override {
    u.assign(area_.size(), Vec{});
    v.assign(area_.size(), Vec{});
    for (std::size_t i = 0; i < area_.size(); ++i) {
      const int k = surface_.same_as[i];
      u[i][2] = s_.u[k] + dt_ * (s_.v[k] + 0.5 * dt_ * s_.a[k]);
      v[i][2] = s_.v[k] + dt_ * s_.a[k];
    }
  }

  void motion(std::vector<Vec>& u, std::vector<Vec>& v) const override {
    u.assign(area_.size(), Vec{});
    v.assign(area_.size(), Vec{});
    for (std::size_t i = 0; i < area_.size(); ++i) {
      u[i][2] = s_.u[surface_.same_as[i]];
      v[i][2] = s_.v[surface_.same_as[i]];
    }
  }

  void advance(const std::vector<Vec>& forces) override {
    if (!(dt_ > 0)) throw RunError("subgrade: set_step() must come before advance()");
    std::fill(force_.begin(), force_.end(), 0.);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      if (!std::isfinite(forces[i][2]))
        throw RunError(text("subgrade: the contact force on surface node ", i,
                            " is not finite; the time step is probably too large"));
      force_[surface_.same_as[i]] += forces[i][2];
    }
    const double am = scheme_.alpha_m, af = scheme_.alpha_f, beta = scheme_.beta,
                 gamma = scheme_.gamma;
    const double dt = dt_, w = 1 - af;
    for (std::size_t i = 0; i < area_.size(); ++i) {
      if (!(area_[i] > 0)) continue;  // an image
      const double m = p_.mass * area_[i], c = p_.dashpot * area_[i], k = p_.stiffness * area_[i];
      double &u = s_.u[i], &v = s_.v[i], &a = s_.a[i], &f = s_.f[i];
      const double rhs = w * force_[i] + af * f - m * am * a - c * (v + w * dt * (1 - gamma) * a) -
                         k * (u + w * dt * (v + dt * (0.5 - beta) * a));
      const double next = rhs / ((1 - am) * m + w * (gamma * dt * c + beta * dt * dt * k));
      const double du = dt * (v + dt * ((0.5 - beta) * a + beta * next));
      const double dv = dt * ((1 - gamma) * a + gamma * next);
      work_ += (f + force_[i]) / 2 * du;
      damping_ += c * (v + dv / 2) * du;
      u += du;
      v += dv;
      a = next;
      f = force_[i];
    }
  }

  int loads() const override { return 0; }
  void set_load(int, double) override { throw RunError("subgrade: it has no loads"); }
  Vec load_displacement(int) const override { throw RunError("subgrade: it has no loads"); }

  double mass() const override { return p_.mass * (p_.x_high - p_.x_low) * (p_.y_high - p_.y_low); }
  double least_surface_mass() const override {
    double least = mass();
    for (double a : area_)
      if (a > 0) least = std::min(least, p_.mass * a);
    return least;
  }
  double largest_frequency() const override { return std::sqrt(p_.stiffness / p_.mass); }
  int unknowns() const override {
    return static_cast<int>(
        std::count_if(area_.begin(), area_.end(), [](double a) { return a > 0; }));
  }

  StructureEnergy energy() const override {
    StructureEnergy e;
    for (std::size_t i = 0; i < area_.size(); ++i) {
      e.kinetic += 0.5 * p_.mass * area_[i] * s_.v[i] * s_.v[i];
      e.strain += 0.5 * p_.stiffness * area_[i] * s_.u[i] * s_.u[i];
    }
    e.work_surface = work_;
    e.dissipated_damping = damping_;
    e.numerical = work_ - e.kinetic - e.strain - damping_;
    return e;
  }

  void save(std::vector<double>& state) const override {
    state = {work_, damping_};
    for (const auto* field : {&s_.u, &s_.v, &s_.a, &s_.f})
      state.insert(state.end(), field->begin(), field->end());
  }
  void load(const std::vector<double>& state) override {
    const std::size_t n = area_.size();
    if (state.size() != 2 + 4 * n)
      throw InputError(text("subgrade: the saved state has ", state.size(),
                            " numbers, this bed needs ", 2 + 4 * n, "; it belongs to another bed"));
    work_ = state[0];
    damping_ = state[1];
    auto from = state.begin() + 2;
    for (auto* field : {&s_.u, &s_.v, &s_.a, &s_.f}) {
      std::copy_n(from, n, field->begin());
      from += static_cast<std::ptrdiff_t>(n);
    }
  }

 private:
  PointBedParameters p_;
  Scheme scheme_;
  SurfaceMesh surface_;
  std::vector<double> area_;  // of each node [m2], 0 for an image
  Motion s_;
  std::vector<double> force_;
  double dt_ = 0, work_ = 0, damping_ = 0;
};

}  // namespace

std::unique_ptr<Structure> make_point_bed(const PointBedParameters& p) {
  return std::make_unique<PointBed>(p);
}

}  // namespace trackbed::fem
