#include "apps/trackbed/simulation/structures.h"

#include "fem/subgrades/registry.h"

namespace trackbed::apps {
namespace {

void set_time_integration(const Scene& s, fem::ElasticBodyParameters& p) {
  p.rho_inf = s.numerics.spectral_radius;
  p.newmark = s.numerics.spectral_radius == 1;
}

}  // namespace

std::vector<std::string> sleeper_contact(const Scene& s) {
  std::vector<std::string> faces{"bottom", "top", "x_max", "y_min",
                                 "y_max"};  // stones may lie on it
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
  if (!s.mesh.empty()) {  // drawn about the middle of its base
    p.mesh.file = s.mesh;
    p.mesh.corner = {0, 0, base};
  }
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
  if (scene.numerics.exchange == "explicit") p.mass = fem::Mass::lumped;
  return std::make_unique<fem::ElasticBody>(std::move(p));
}

std::unique_ptr<fem::Structure> make_subgrade_structure(const Scene& scene, const Layout& l) {
  fem::SubgradeSite site;
  site.x_low = l.low.x(), site.x_high = l.high.x();
  site.y_low = l.low.y(), site.y_high = l.high.y();
  site.top = l.low.z();
  site.element_size = scene.subgrade.element_size;
  site.order = scene.subgrade.order;
  site.periodic_y = scene.container.periodic;
  site.rho_inf = scene.numerics.spectral_radius;
  site.newmark = scene.numerics.spectral_radius == 1;
  return fem::make_subgrade(scene.subgrade.model, site, scene.subgrade.values);
}

}  // namespace trackbed::apps
