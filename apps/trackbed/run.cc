#include "apps/trackbed/commands.h"
#include "base/error.h"

namespace trackbed::apps {

int run_command(const RunOptions&) { throw RunError("run: not in this build yet"); }

}  // namespace trackbed::apps
