// A kept packing as files for other programs.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// About Packing/Origin. Writes `folder`/packing.off, .vtu, .csv (with packing_shapes/), as
/// `formats` name them; returns the files. Throws RunError when one cannot be written.
std::vector<std::string> export_packing(const Scene&, const std::string& kept,
                                        const std::vector<std::string>& formats,
                                        const std::string& folder);

}  // namespace trackbed::apps
