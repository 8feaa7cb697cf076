// The bound on the time step that contacts set to a body: mass that is consistent, forces found at
// the predicted surface.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/contact_bound.h"
#include "fem/elastic_body.h"

using namespace trackbed::fem;

namespace {

constexpr double kSpring = 1e6, kMass = 1000;

// A free block of one metre, 1000 kg.
ElasticBodyParameters block(int elements, double young, double rho_inf) {
  ElasticBodyParameters p;
  Material m;
  m.name = "block", m.young = young, m.poisson = 0, m.density = kMass;
  p.materials = {m};
  p.mesh.corner = {0, 0, 0};
  p.mesh.lengths = {1, 1, 0};
  p.mesh.elements = {elements, elements, 1};
  p.mesh.layers = {{1, elements, 0}};
  p.contact = {"bottom", "top"};
  p.newmark = rho_inf == 1;
  p.rho_inf = rho_inf;
  return p;
}

NodeSpring spring(int node, double k) {
  return {node, {Vec{k, 0, 0}, Vec{0, k, 0}, Vec{0, 0, k}}, k};
}

// On springs under all nodes of the bottom; they come doubled, as those of contacts.
std::vector<NodeSpring> springs_below(const ElasticBody& body) {
  std::vector<NodeSpring> all;
  const auto& nodes = body.surface().nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i][2] == 0) all.push_back(spring(static_cast<int>(i), 2 * kSpring));
  return all;
}

// Largest displacement after many steps of dt from a jolt, over that after few.
double growth(ElasticBody& body, double dt, int steps) {
  const auto& nodes = body.surface().nodes;
  std::vector<Vec> u, v, force(nodes.size(), Vec{});
  body.set_step(dt);
  double early = 0, late = 0;
  for (int n = 0; n < steps; ++n) {
    body.predict(u, v);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int d = 0; d < 3; ++d)
        force[i][d] =
            (nodes[i][2] == 0 ? -kSpring * u[i][d] : 0.) + (n == 0 && i == 0 ? 1e3 * (d + 1) : 0.);
    body.advance(force);
    double& largest = n < 20 ? early : late;
    for (const Vec& w : u) largest = std::max(largest, std::abs(w[2]));
    if (late > 1e6 * early) break;
  }
  return late / early;
}

}  // namespace

// One element: (M⁻¹)ᵢᵢ of a corner is 64/m, eight times that of the lumped mass; of all corners
// moving against their neighbours 216/m.
TEST(ContactBound, CountsTheConsistentMassOfACube) {
  const ElasticBody body(block(1, 1e9, 1));
  ASSERT_EQ(body.surface().nodes.size(), 8u);
  EXPECT_NEAR(body.contact_bound({spring(3, kSpring)}) / (64 * kSpring / kMass), 1.05, 1e-9);
  std::vector<NodeSpring> all;
  for (int i = 0; i < 8; ++i) all.push_back(spring(i, kSpring));
  EXPECT_NEAR(body.contact_bound(all) / (216 * kSpring / kMass), 1.05, 0.01);
}

TEST(ContactBound, HoldsForSoftAndStiffBlocks) {
  for (const double rho_inf : {1., 0.9})
    for (const int elements : {1, 2, 3})
      for (const double young : {1e6, 1e8, 1e10}) {
        SCOPED_TRACE(testing::Message() << rho_inf << ' ' << elements << ' ' << young);
        ElasticBody body(block(elements, young, rho_inf));
        const double limit = 1 / std::sqrt(body.contact_bound(springs_below(body)));
        EXPECT_LT(growth(body, 0.95 * limit, 4000), 3);
      }
}

// Lumped masses of nodes, as if each stood alone, would call a step safe that is not.
TEST(ContactBound, NodesAloneWouldAllowWhatGrows) {
  ElasticBody body(block(2, 1e8, 0.9));
  const double lumped = body.Structure::contact_bound(springs_below(body));
  EXPECT_GT(growth(body, 0.95 / std::sqrt(lumped), 4000), 1e3);
}
