#include <cstdio>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/simulate.h"

namespace trackbed::apps {

int run_command(const RunOptions& o) {
  const Scene scene = read_scene(o.scene, o.set);
  const std::string path = o.output.empty() ? "results/" + scene.name : o.output;
  OutputFolder folder(path, earlier_run(o.resume, o.overwrite));
  catch_stop_signals();
  Progress progress;
  const Ending ending = simulate(scene, {folder.path(), o.threads, o.resume, false}, progress);
  if (ending == Ending::stopped) {
    std::fprintf(stderr, "trackbed: stopped; go on with: trackbed run %s --output %s --resume\n",
                 o.scene.c_str(), path.c_str());
    return 128 + stop_signal();
  }
  std::printf("results in %s; trackbed report %s draws them\n", path.c_str(), path.c_str());
  return 0;
}

}  // namespace trackbed::apps
