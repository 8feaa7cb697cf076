#include "apps/trackbed/commands.h"
#include "base/error.h"

namespace trackbed::apps {

int compare_command(const CompareOptions&) { throw RunError("compare: not in this build yet"); }

}  // namespace trackbed::apps
