// Packings are made once and kept, named by a hash of everything that goes into them.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// Name of the scene's packing: a hash over every parameter that it depends on.
std::string packing_name(const Scene&);

/// Files of a kept packing; `compaction` are the rows of its compaction.csv, and so on.
struct KeptPacking {
  std::string state, compaction, friction_path;
};
KeptPacking kept_packing(const Scene&);

/// Takes a kept packing into the run. False if there is none (or Packing/Reuse is off).
bool take_packing(Run&, const std::string& folder);

/// Keeps the run's packing, with the compaction.csv of `folder`.
void keep_packing(Run&, const std::string& folder);

}  // namespace trackbed::apps
