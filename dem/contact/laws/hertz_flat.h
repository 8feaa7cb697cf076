// Hertz and Mindlin, with flat faces of dilated polyhedra that answer by the area on which they
// meet, on each other, on rigid bodies and on deforming surfaces (contact/flat_contact.h,
// surface/flat_patch.h). On all other contacts it is hertz_mindlin.
#pragma once
#include "dem/contact/laws/hertz_mindlin.h"

namespace trackbed::dem {

struct HertzFlatLaw : HertzMindlinLaw {
  static constexpr const char* name = "hertz_flat";
  static constexpr bool flats = true;
};

}  // namespace trackbed::dem
