// The laws of grain contacts by name. A new law is one header in laws/ and one word here.
#include <tuple>

#include "base/error.h"
#include "dem/contact/laws/shao2017.h"
#include "dem/contact/laws/stored_energy.h"
#include "dem/contact/pair_evaluate.h"

namespace trackbed::dem {
namespace {

using Laws = std::tuple<StoredEnergyLaw, Shao2017Law>;

template <class F>
void for_each_law(F&& f) {
  std::apply([&](auto... law) { (f(law), ...); }, Laws());
}

}  // namespace

std::vector<std::string> pair_law_names() {
  std::vector<std::string> names;
  for_each_law([&](auto law) { names.push_back(law.name); });
  return names;
}

PairForces make_pair_forces(const std::string& name, bool friction) {
  PairForces forces;
  for_each_law([&](auto law) {
    if (name == law.name) forces = pair_forces_of<decltype(law)>(friction);
  });
  if (forces.evaluate) return forces;
  std::string known;
  for (const std::string& n : pair_law_names()) known += (known.empty() ? "'" : ", '") + n + "'";
  throw InputError("there is no contact law '" + name + "'; the laws are " + known);
}

}  // namespace trackbed::dem
