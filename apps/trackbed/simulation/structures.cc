#include "apps/trackbed/simulation/structures.h"

#include <algorithm>

#include "fem/beam.h"
#include "fem/distributed_body.h"
#include "fem/reduction.h"
#include "fem/subgrades/registry.h"

namespace trackbed::apps {
namespace {

void set_time_integration(const Scene& s, fem::ElasticBodyParameters& p) {
  p.rho_inf = s.numerics.spectral_radius;
  p.newmark = s.numerics.spectral_radius == 1;
  p.scheme = fem::time_scheme_of(s.numerics.scheme);
  p.solver = fem::solver_of(s.numerics.solver);
}

std::unique_ptr<fem::Structure> make_beam_sleeper(const Scene& scene, const Layout& l,
                                                  double base) {
  const SleeperScene& s = scene.sleeper;
  fem::BeamParameters p;
  p.low_x = l.sleeper_low_x, p.high_x = l.sleeper_high_x;
  p.width = s.width, p.height = s.height, p.base = base;
  p.elements = static_cast<int>(s.elements[0] * l.share + 0.5);
  p.cells_y = static_cast<int>(s.elements[1]), p.cells_z = static_cast<int>(s.elements[2]);
  p.young = s.modulus, p.poisson = s.poisson, p.density = s.density;
  p.half = scene.container.half;
  for (const RailSeat& seat : rail_seats(scene))
    p.loads.push_back({"seat", (seat.low + seat.high) / 2, seat.high - seat.low, {0, 0, -1}});
  if (scene.loading.push == "lateral") p.loads.push_back({"push", p.high_x, 0, {1, 0, 0}});
  if (scene.loading.push == "longitudinal")
    p.loads.push_back({"push", 0.5 * (p.low_x + p.high_x), p.high_x - p.low_x, {0, 1, 0}});
  p.gravity = {0, 0, -9.81};
  return fem::make_beam(p);
}

}  // namespace

std::vector<std::string> sleeper_contact(const Scene& s) {
  std::vector<std::string> faces{"bottom", "top", "x_max", "y_min",
                                 "y_max"};  // stones may lie on it
  if (!s.container.half) faces.push_back("x_min");
  return faces;
}

std::vector<RailSeat> rail_seats(const Scene& scene) {
  std::vector<RailSeat> seats;
  const bool half = scene.container.half;
  const double reach = scene.sleeper.seat_length / 2;
  for (const double x : scene.sleeper.seats)
    if (!half || x >= 0)
      seats.push_back({x, half ? std::max(0.0, x - reach) : x - reach, x + reach});
  return seats;
}

int seat_loads(const Scene& scene) { return static_cast<int>(rail_seats(scene).size()); }

std::unique_ptr<fem::Structure> make_elastic_sleeper(const Scene& scene, const Layout& l,
                                                     double base) {
  if (scene.sleeper.model == "beam") return make_beam_sleeper(scene, l, base);
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
  for (const RailSeat& at : rail_seats(scene)) {
    fem::Load seat;
    seat.name = "seat";
    seat.boundary = "top";
    seat.rectangle = true;
    seat.centre_x = (at.low + at.high) / 2, seat.centre_y = 0;
    seat.size_x = at.high - at.low, seat.size_y = s.seat_width;
    p.loads.push_back(seat);
  }
  if (scene.loading.push != "none") {
    fem::Load push;
    push.name = "push";
    push.boundary = scene.loading.push == "lateral" ? "x_max" : "y_min";
    push.direction = {scene.loading.push == "lateral" ? 1. : 0.,
                      scene.loading.push == "lateral" ? 0. : 1., 0};
    p.loads.push_back(push);
  }
  p.contact = sleeper_contact(scene);
  p.gravity = {0, 0, -9.81};
  p.start_in_equilibrium = false;  // it lies on the grains
  set_time_integration(scene, p);
  if (scene.numerics.exchange == "explicit") p.mass = fem::Mass::lumped;
  if (s.reduction != "none")
    return fem::reduced_body(std::move(p), fem::reduction_of(s.reduction), s.modes);
  return fem::make_elastic_body(std::move(p));
}

std::unique_ptr<fem::Structure> make_subgrade_structure(const Scene& scene, const Layout& l) {
  fem::SubgradeSite site;
  site.x_low = l.low.x(), site.x_high = l.high.x();
  site.y_low = l.low.y(), site.y_high = l.high.y();
  site.top = l.low.z();
  site.element_size = scene.subgrade.element_size;
  site.order = scene.subgrade.order;
  site.mirror_x = scene.container.half;
  site.periodic_y = scene.container.periodic;
  site.rho_inf = scene.numerics.spectral_radius;
  site.newmark = scene.numerics.spectral_radius == 1;
  site.scheme = scene.subgrade.inertia == "off" ? fem::TimeScheme::quasi_static
                                                : fem::time_scheme_of(scene.numerics.scheme);
  site.solver = fem::solver_of(scene.numerics.solver);
  site.reduction = fem::reduction_of(scene.subgrade.reduction);
  site.modes = scene.subgrade.modes;
  site.absorbing_sides = scene.subgrade.absorbing == "sides" || scene.subgrade.absorbing == "all";
  site.absorbing_bottom = scene.subgrade.absorbing == "bottom" || scene.subgrade.absorbing == "all";
  const double load = 2 * M_PI * scene.loading.frequency;
  site.damping = fem::rayleigh_damping(scene.subgrade.damping_ratio, load, 10 * load);
  return fem::make_subgrade(scene.subgrade.model, site, scene.subgrade.values);
}

void serve_structures(const Scene& scene) {
  const Layout layout = make_layout(scene);
  fem::serve([&](int, double base) {
    const fem::BuildingTogether together;
    std::vector<std::unique_ptr<fem::Structure>> built;
    if (scene.sleeper.model != "rigid") built.push_back(make_elastic_sleeper(scene, layout, base));
    if (scene.subgrade.model != "rigid") built.push_back(make_subgrade_structure(scene, layout));
    return built;
  });
}

}  // namespace trackbed::apps
