#include "apps/trackbed/check_grain_test.h"

#include <algorithm>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/actors.h"

namespace trackbed::apps {
namespace {

// A test has grains and walls, nothing else.
void check_bodies(const Scene& s, const ParameterValues& values) {
  const std::string at = "Test/Type = " + s.test.type;
  if (s.sleeper.model != "rigid")
    values.refuse("Sleeper/Model", at + " has no sleeper to bend; set it to rigid");
  if (s.subgrade.model != "rigid")
    values.refuse("Subgrade/Model", at + " stands on a rigid floor; set it to rigid");
  if (s.loading.push != "none") values.refuse("Loading/Push", at + " has no sleeper to push");
  if (s.container.shape != "box") values.refuse("Container/Shape", at + " needs a box");
  if (s.container.half) values.refuse("Container/Half by symmetry", at + " needs the whole box");
  if (s.container.shoulder_width > 0)
    values.refuse("Container/Shoulder width", at + " needs a full box");
  if (s.container.periodic && s.test.type != "angle_of_repose")
    values.refuse("Container/Periodic along track", at + " needs walls on all sides");
  if (s.zones.use) values.refuse("Zones/Use", at + " has no sleeper, so no zone that matters less");
}

}  // namespace

void check_grain_test(const Scene& s, const ParameterValues& values) {
  if (!s.test.on()) return;
  check_bodies(s, values);
  if (s.test.stresses.empty() && s.test.type != "angle_of_repose")
    values.refuse("Test/Stresses", "at least one is needed");
  if (s.test.type == "direct_shear") {
    // Beyond half of the box too little of it is still sheared; walls are so thick.
    const double most = std::min(0.5 * s.container.length, wall_thickness);
    if (s.test.travel > most)
      values.refuse("Test/Travel",
                    "beyond the box: at most " + shortest(most) +
                        " m, half of Container/Length and the thickness of its walls");
  }
}

}  // namespace trackbed::apps
