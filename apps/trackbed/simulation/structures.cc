#include "apps/trackbed/simulation/structures.h"

#include <cmath>
#include <sstream>

#include "base/error.h"

namespace trackbed::apps {
namespace {

int divisions(double length, double size) {
  return std::max(1, static_cast<int>(std::ceil(length / size - 1e-9)));
}

void set_time_integration(const Scene& s, fem::ElasticBodyParameters& p) {
  p.rho_inf = s.numerics.spectral_radius;
  p.newmark = s.numerics.spectral_radius == 1;
}

}  // namespace

std::vector<std::string> sleeper_contact(const Scene& s) {
  std::vector<std::string> faces{"bottom", "x_max", "y_min", "y_max"};
  if (!s.container.half) faces.push_back("x_min");
  return faces;
}

std::unique_ptr<fem::ElasticBody> make_elastic_sleeper(const Scene& scene, const Layout& l,
                                                       double base) {
  const SleeperScene& s = scene.sleeper;
  fem::ElasticBodyParameters p;
  p.name = "Sleeper";
  p.mesh.corner = {l.sleeper_low_x, l.sleeper_low_y, base};
  p.mesh.lengths = {l.sleeper_high_x - l.sleeper_low_x, s.width, s.height};
  p.mesh.elements = {static_cast<int>(s.elements[0] * l.share + 0.5),
                     static_cast<int>(s.elements[1]), static_cast<int>(s.elements[2])};
  fem::Material concrete;
  concrete.name = "concrete";
  concrete.young = s.modulus, concrete.poisson = s.poisson, concrete.density = s.density;
  p.materials = {concrete};
  if (s.pad_thickness > 0) {
    fem::Material pad;
    pad.name = "pad";
    pad.young = s.pad_modulus, pad.poisson = s.pad_poisson, pad.density = s.pad_density;
    p.materials.push_back(pad);
    p.mesh.layers = {{s.pad_thickness, 1, 1}, {s.height - s.pad_thickness, p.mesh.elements[2], 0}};
  }
  p.mesh.file = s.mesh;
  p.order = s.order;
  if (scene.container.half) p.supports["x_min"] = fem::Support::roller;
  for (const double x : s.seats) {
    if (scene.container.half && x < 0) continue;
    fem::Load seat;
    seat.name = "seat";
    seat.boundary = "top";
    seat.rectangle = true;
    seat.centre_x = x, seat.centre_y = 0;
    seat.size_x = s.seat_length, seat.size_y = s.seat_width;
    if (scene.container.half && x < 0.5 * s.seat_length) {  // a seat on the plane of symmetry
      seat.size_x = 0.5 * s.seat_length + x;
      seat.centre_x = 0.5 * seat.size_x;
    }
    p.loads.push_back(seat);
  }
  p.contact = sleeper_contact(scene);
  p.gravity = {0, 0, -9.81};
  p.start_in_equilibrium = false;  // it lies on the grains
  set_time_integration(scene, p);
  return std::make_unique<fem::ElasticBody>(std::move(p));
}

std::unique_ptr<fem::ElasticBody> make_elastic_subgrade(const Scene& scene, const Layout& l) {
  const SubgradeScene& s = scene.subgrade;
  fem::ElasticBodyParameters p;
  p.name = "Subgrade";
  p.mesh.corner = {l.low.x(), l.low.y(), -s.depth};
  p.mesh.lengths = {l.high.x() - l.low.x(), l.high.y() - l.low.y(), s.depth};
  if (s.elements.size() >= 2)
    p.mesh.elements = {static_cast<int>(s.elements[0] * l.share + 0.5),
                       static_cast<int>(s.elements[1]), 1};
  else
    p.mesh.elements = {divisions(p.mesh.lengths[0], s.element_size),
                       divisions(p.mesh.lengths[1], s.element_size), 1};
  // Layers are written from the top down, meshed from the bottom up.
  std::stringstream text(s.layers);
  for (std::string one; std::getline(text, one, ',');) {
    std::stringstream numbers(one);
    double v[4];
    char colon;
    numbers >> v[0] >> colon >> v[1] >> colon >> v[2] >> colon >> v[3];
    if (!numbers) throw InputError("Subgrade/Layers: '" + one + "' is not thickness:E:nu:density");
    fem::Material m;
    m.name = "layer " + std::to_string(p.materials.size() + 1);
    m.young = v[1], m.poisson = v[2], m.density = v[3];
    p.mesh.layers.insert(p.mesh.layers.begin(), {v[0], divisions(v[0], s.element_size),
                                                 static_cast<int>(p.materials.size())});
    p.materials.push_back(m);
  }
  p.mesh.file = s.mesh;
  p.order = s.order;
  p.supports["bottom"] = fem::Support::fixed;
  p.supports["x_min"] = p.supports["x_max"] = fem::Support::roller;
  const auto sides = scene.container.periodic ? fem::Support::periodic : fem::Support::roller;
  p.supports["y_min"] = p.supports["y_max"] = sides;
  p.contact = {"top"};
  set_time_integration(scene, p);
  return std::make_unique<fem::ElasticBody>(std::move(p));
}

}  // namespace trackbed::apps
