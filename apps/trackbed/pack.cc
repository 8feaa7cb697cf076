#include <algorithm>
#include <cstdio>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/export_packing.h"
#include "apps/trackbed/simulation/packing_store.h"
#include "apps/trackbed/simulation/simulate.h"

namespace trackbed::apps {

int pack_command(const PackOptions& o) {
  const Scene scene = read_scene(o.scene, o.set);
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
