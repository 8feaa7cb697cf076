#include <algorithm>
#include <cstdio>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/export_packing.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/packing_store.h"
#include "apps/trackbed/simulation/simulate.h"
#include "base/error.h"

namespace trackbed::apps {

namespace {

// Known before hours of packing.
void check_formats(const Scene& scene, const std::vector<std::string>& formats) {
  if (!std::count(formats.begin(), formats.end(), "off") || !has_shape(scene, "clump")) return;
  const GrainScene& g = scene.grains;
  throw InputError(
      std::string("--export off: ") +
      (g.other_share < 1 && g.shape == "clump" ? "Grains/Shape" : "Grains/Other shape") +
      " = clump: clumps are no single closed solids; allowed are csv, vtu");
}

}  // namespace

int pack_command(const PackOptions& o) {
  const Scene scene = read_scene(o.scene, o.set);
  check_formats(scene, o.formats);
  const std::string path = o.output.empty() ? "results/" + scene.name : o.output;
  OutputFolder folder(path, earlier_run(false, o.overwrite));
  catch_stop_signals();
  Progress progress;
  const Ending ending = simulate(scene, {folder.path(), o.threads, false, true}, progress);
  if (ending == Ending::stopped) return 128 + stop_signal();
  const std::string kept = kept_packing(scene).state;
  for (const std::string& file : export_packing(scene, kept, o.formats, folder.path()))
    std::printf("%s\n", file.c_str());
  std::printf("packing in %s, kept as %s\n", path.c_str(), kept.c_str());
  return 0;
}

}  // namespace trackbed::apps
