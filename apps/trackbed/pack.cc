#include "apps/trackbed/commands.h"
#include "base/error.h"

namespace trackbed::apps {

int pack_command(const PackOptions&) { throw RunError("pack: not in this build yet"); }

}  // namespace trackbed::apps
