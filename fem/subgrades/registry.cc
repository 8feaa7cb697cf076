#include "fem/subgrades/registry.h"

#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "fem/distributed_body.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

std::map<std::string, SubgradeModel>& models() {
  static std::map<std::string, SubgradeModel>
      all;  // made at first use: files register in any order
  return all;
}

void check(const std::string& model, const Parameter& p, const std::string& value) {
  if (p.kind != ParameterKind::number && p.kind != ParameterKind::integer) return;
  const std::string where = text("Subgrade/", model, "/", p.key, " = ", value, ": ");
  std::size_t used = 0;
  double number = 0;
  try {
    number = std::stod(value, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || value.find_first_not_of(" \t", used) != std::string::npos)
    throw InputError(where + "not a number [" + p.unit + "]");
  if (!(number >= p.least && number <= p.most))
    throw InputError(where + text("allowed are ", p.least, " to ", p.most, " ", p.unit));
}

}  // namespace

const std::map<std::string, SubgradeModel>& subgrade_models() { return models(); }

RegisterSubgrade::RegisterSubgrade(SubgradeModel model) {
  const std::string name = model.name;
  if (!models().emplace(name, std::move(model)).second)
    throw std::logic_error("two subgrade models are named '" + name + "'");
}

namespace {

// The model of that name; values completed by its defaults and checked.
const SubgradeModel& checked(const std::string& name, Values& values) {
  const auto found = models().find(name);
  if (found == models().end())
    throw InputError(
        text("Subgrade model '", name, "' is not known; there are ", names_of(models())));
  const SubgradeModel& model = found->second;
  for (const auto& [key, value] : values) {
    bool known = false;
    std::string keys;
    for (const Parameter& p : model.parameters) {
      known |= p.key == key;
      keys += (keys.empty() ? "" : ", ") + p.key;
    }
    if (!known) throw InputError(text("Subgrade/", name, ": no key '", key, "'; there are ", keys));
  }
  for (const Parameter& p : model.parameters) {
    values.emplace(p.key, p.fallback);
    check(name, p, values.at(p.key));
  }
  return model;
}

std::unique_ptr<Structure> body_with_history(const SubgradeSite& site, const Values& values,
                                             std::shared_ptr<const StressModel> stress) {
  if (site.scheme != TimeScheme::automatic)
    throw InputError(
        "Numerics/Structure scheme: a material with history is advanced explicitly where the step "
        "allows it, else implicitly; automatic is allowed");
  if (site.reduction != Reduction::none)
    throw InputError("Subgrade/Reduction: a material with history has no modes; none is allowed");
  if (site.absorbing_sides || site.absorbing_bottom)
    throw InputError(
        "Subgrade/Absorbing: boundaries absorb the waves of an elastic material only; none is "
        "allowed");
  if (site.damped())
    throw InputError(
        "Subgrade/Damping ratio: Rayleigh's damping needs the constant stiffness of an elastic "
        "material; 0 is allowed");
  ElasticBodyParameters p = box_under(site);
  const double depth = number(values, "Depth");
  p.mesh.layers = {{depth, cells_over(site, depth), 0}};
  p.mesh.corner[2] -= depth;
  p.solver = site.solver;
  return make_body_with_history(std::move(p), std::move(stress));
}

}  // namespace

std::unique_ptr<Structure> make_subgrade(const std::string& name, const SubgradeSite& site,
                                         Values values) {
  const SubgradeModel& model = checked(name, values);
  return model.stress ? body_with_history(site, values, model.stress(values))
                      : model.build(site, values);
}

std::shared_ptr<const StressModel> stress_model(const std::string& name, Values values) {
  const SubgradeModel& model = checked(name, values);
  return model.stress ? model.stress(values) : nullptr;
}

double number(const Values& values, const std::string& key) {
  const auto found = values.find(key);
  if (found == values.end())
    throw InputError("Subgrade: the model reads '" + key + "', which is none of its parameters");
  return std::stod(found->second);
}

int cells_over(const SubgradeSite& site, double length) {
  return std::max(1, static_cast<int>(std::ceil(length / site.element_size - 1e-9)));
}

ElasticBodyParameters box_under(const SubgradeSite& site) {
  ElasticBodyParameters p;
  p.name = "Subgrade";
  p.mesh.corner = {site.x_low, site.y_low, site.top};  // lowered by the model
  p.mesh.lengths = {site.x_high - site.x_low, site.y_high - site.y_low, 0};
  p.mesh.elements = {cells_over(site, p.mesh.lengths[0]), cells_over(site, p.mesh.lengths[1]), 1};
  p.order = site.order;
  p.supports["bottom"] = Support::fixed;
  p.supports["x_min"] = p.supports["x_max"] = site.periodic_x ? Support::periodic : Support::roller;
  p.supports["y_min"] = p.supports["y_max"] = site.periodic_y ? Support::periodic : Support::roller;
  p.contact = {"top"};
  p.newmark = site.newmark;
  p.rho_inf = site.rho_inf;
  return p;
}

std::unique_ptr<Structure> make_body(const SubgradeSite& site, ElasticBodyParameters p) {
  p.scheme = site.scheme;
  p.solver = site.solver;
  for (Material& m : p.materials)
    m.rayleigh_mass += site.damping.mass, m.rayleigh_stiffness += site.damping.stiffness;
  double depth = 0;
  for (const Layer& layer : p.mesh.layers) depth += layer.thickness;
  const auto absorb = [&](const char* boundary, double distance) {
    p.supports.erase(boundary);
    Bed bed;
    bed.boundary = boundary;
    bed.absorbing = true;
    bed.distance = distance;
    p.beds.push_back(bed);
  };
  if (site.absorbing_bottom) absorb("bottom", depth);
  if (site.absorbing_sides && !site.periodic_x)
    for (const char* side : {"x_min", "x_max"})
      if (!site.mirror_x || std::string(side) == "x_max")
        absorb(side, (site.x_high - site.x_low) / (site.mirror_x ? 1 : 2));
  if (site.absorbing_sides && !site.periodic_y)
    for (const char* side : {"y_min", "y_max"}) absorb(side, (site.y_high - site.y_low) / 2);
  if (site.reduction == Reduction::none) return make_elastic_body(std::move(p));
  return reduced_body(std::move(p), site.reduction, site.modes);
}

PointBedParameters points_under(const SubgradeSite& site) {
  if (site.scheme != TimeScheme::automatic && site.scheme != TimeScheme::newmark &&
      site.scheme != TimeScheme::generalised_alpha)
    throw InputError(
        "Numerics/Structure scheme: a bed of points is advanced implicitly; automatic, newmark or "
        "generalised_alpha are allowed");
  if (site.reduction != Reduction::none)
    throw InputError("Subgrade/Reduction: points of a bed have no modes to share; none is allowed");
  if (site.absorbing_sides || site.absorbing_bottom)
    throw InputError(
        "Subgrade/Absorbing: a bed of points has no sides and no bottom; none is allowed");
  if (site.damped())
    throw InputError(
        "Subgrade/Damping ratio: a bed of points is damped by dashpots of its own (kelvin_voigt); "
        "0 is allowed");
  PointBedParameters p;
  p.x_low = site.x_low, p.x_high = site.x_high;
  p.y_low = site.y_low, p.y_high = site.y_high;
  p.top = site.top;
  p.cells_x = cells_over(site, site.x_high - site.x_low);
  p.cells_y = cells_over(site, site.y_high - site.y_low);
  p.periodic_x = site.periodic_x, p.periodic_y = site.periodic_y;
  p.newmark = site.newmark || site.scheme == TimeScheme::newmark;
  p.rho_inf = site.rho_inf;
  return p;
}

}  // namespace trackbed::fem
