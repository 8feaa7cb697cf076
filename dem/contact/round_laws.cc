// The laws of round contacts by name. A new law is one header in laws/ and one word here, its
// damping (restitution.cc) and its instance on surfaces (surface/round_patch.cc).
#include <tuple>

#include "base/error.h"
#include "dem/contact/laws/hertz_flat.h"
#include "dem/contact/laws/hertz_mindlin.h"
#include "dem/contact/laws/linear.h"
#include "dem/contact/laws/sun2015.h"
#include "dem/contact/round_evaluate.h"

namespace trackbed::dem {
namespace {

using Laws = std::tuple<HertzMindlinLaw, HertzFlatLaw, Sun2015Law, LinearLaw>;

template <class F>
void for_each_law(F&& f) {
  std::apply([&](auto... law) { (f(law), ...); }, Laws());
}

}  // namespace

std::vector<std::string> round_law_names() {
  std::vector<std::string> names;
  for_each_law([&](auto law) { names.push_back(law.name); });
  return names;
}

RoundForces make_round_forces(const std::string& name, bool friction) {
  RoundForces forces;
  for_each_law([&](auto law) {
    using Law = decltype(law);
    if (name == law.name)
      forces = {name, friction, Law::flats,
                friction ? &evaluate_round<Law, true> : &evaluate_round<Law, false>};
  });
  if (forces.evaluate) return forces;
  std::string known;
  for (const std::string& n : round_law_names()) known += (known.empty() ? "'" : ", '") + n + "'";
  throw InputError("there is no law of round contacts '" + name + "'; the laws are " + known);
}

}  // namespace trackbed::dem
