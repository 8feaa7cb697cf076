#include "apps/trackbed/check_grain_test.h"

#include <algorithm>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/actors.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

struct Check {
  const Scene& scene;
  const ParameterValues& values;

  [[noreturn]] void refuse(const std::string& path, const std::string& why) const {
    throw InputError(values.where(path) + " = " + values.text(path) + ": " + why);
  }
};

// A test has grains and walls, nothing else.
void check_bodies(const Check& c) {
  const Scene& s = c.scene;
  const std::string at = "Test/Type = " + s.test.type;
  if (s.sleeper.model != "rigid")
    c.refuse("Sleeper/Model", at + " has no sleeper to bend; set it to rigid");
  if (s.subgrade.model != "rigid")
    c.refuse("Subgrade/Model", at + " stands on a rigid floor; set it to rigid");
  if (s.loading.push != "none") c.refuse("Loading/Push", at + " has no sleeper to push");
  if (s.container.shape != "box") c.refuse("Container/Shape", at + " needs a box");
  if (s.container.half) c.refuse("Container/Half by symmetry", at + " needs the whole box");
  if (s.container.shoulder_width > 0)
    c.refuse("Container/Shoulder width", at + " needs a full box");
  if (s.container.periodic && s.test.type != "angle_of_repose")
    c.refuse("Container/Periodic along track", at + " needs walls on all sides");
  if (s.zones.use) c.refuse("Zones/Use", at + " has no sleeper, so no zone that matters less");
}

}  // namespace

void check_grain_test(const Scene& s, const ParameterValues& values) {
  if (!s.test.on()) return;
  const Check c{s, values};
  check_bodies(c);
  if (s.test.stresses.empty() && s.test.type != "angle_of_repose")
    c.refuse("Test/Stresses", "at least one is needed");
  if (s.test.type == "direct_shear") {
    // Beyond half of the box too little of it is still sheared; walls are so thick.
    const double most = std::min(0.5 * s.container.length, wall_thickness);
    if (s.test.travel > most)
      c.refuse("Test/Travel", "beyond the box: at most " + shortest(most) +
                                  " m, half of Container/Length and the thickness of its walls");
  }
}

}  // namespace trackbed::apps
