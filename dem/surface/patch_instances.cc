// The instances of the patch loop: one per law and friction on or off.
#include "base/error.h"
#include "dem/contact/laws/shao2017.h"
#include "dem/contact/laws/stored_energy.h"
#include "dem/surface/patch_evaluate.h"

namespace trackbed::dem {
namespace {

template <class Law>
EvaluatePatch instance(bool friction) {
  return friction ? &evaluate_patch<Law, true> : &evaluate_patch<Law, false>;
}

}  // namespace

EvaluatePatch make_patch_forces(const std::string& law, bool friction) {
  if (law == StoredEnergyLaw::name) return instance<StoredEnergyLaw>(friction);
  if (law == Shao2017Law::name) return instance<Shao2017Law>(friction);
  throw InputError("contact law '" + law + "': for surfaces there are " + StoredEnergyLaw::name +
                   ", " + Shao2017Law::name);
}

}  // namespace trackbed::dem
