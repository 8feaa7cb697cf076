// The meshes that come with the project: volume, names, rail seats.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/elastic_body.h"

using namespace trackbed::fem;

TEST(Meshes, SleeperB70) {
  ElasticBodyParameters p;
  p.name = "Sleeper";
  p.mesh.file = TRACKBED_MESHES "/sleeper_b70.msh";
  p.mesh.region_material = {{"concrete", 0}};
  p.materials = {{"concrete", 40e9, 0.2, 2500}};
  p.contact = {"bottom", "x_min", "x_max", "y_min", "y_max"};
  p.loads = {{"left", "top", true, -0.75, 0, 0.15, 0.15},
             {"right", "top", true, 0.75, 0, 0.15, 0.15}};
  ElasticBody body(p);
  // Sections between stations: base width b and height h are linear, the area b h − 0.3 h².
  const double x[] = {-1.3, -0.9, -0.6, -0.4, 0.4, 0.6, 0.9, 1.3};
  const double b[] = {0.3, 0.3, 0.3, 0.22, 0.22, 0.3, 0.3, 0.3};
  const double h[] = {0.2, 0.21, 0.21, 0.175, 0.175, 0.21, 0.21, 0.2};
  double volume = 0;
  for (int i = 0; i < 7; ++i) {
    const auto area = [&](double t) {
      const double width = b[i] + t * (b[i + 1] - b[i]), height = h[i] + t * (h[i + 1] - h[i]);
      return width * height - 0.3 * height * height;
    };
    volume += (x[i + 1] - x[i]) * (area(0) + 4 * area(0.5) + area(1)) / 6;
  }
  EXPECT_NEAR(body.mass(), 2500 * volume, 1e-9 * 2500 * volume);
  EXPECT_EQ(body.surface().quads.size(), static_cast<std::size_t>(26 * 3 + 2 * 26 * 2 + 2 * 6));

  body.set_step(1e-5);
  body.set_load(0, 1000);
  body.set_load(1, 1000);
  std::vector<Vec> f(body.surface().nodes.size(), Vec{});
  for (int n = 0; n < 10; ++n) body.advance(f);
  EXPECT_LT(body.load_displacement(0)[2], 0);
  EXPECT_NEAR(body.load_displacement(0)[2], body.load_displacement(1)[2],
              1e-9 * std::abs(body.load_displacement(0)[2]));
  EXPECT_NEAR(body.momentum()[0], 0, 1e-9);
}
