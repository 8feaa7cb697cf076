#include <cstdio>
#include <filesystem>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/simulate.h"
#include "apps/trackbed/simulation/structures.h"
#include "base/error.h"
#include "fem/distributed_body.h"
#include "fem/session.h"

namespace trackbed::apps {

int run_command(const RunOptions& o) {
  const Scene scene = read_scene(o.scene, o.set);
  if (fem::rank() > 0) {
    catch_stop_signals();  // rank 0 answers them
    serve_structures(scene);
    return 0;
  }
  const struct Release {
    ~Release() { fem::release_ranks(); }
  } release;
  const std::string path = o.output.empty() ? "results/" + scene.name : o.output;
  const std::string resume = resume_command("run", o.scene, path, o.set);
  OutputFolder folder(path, earlier_run(o.resume, o.overwrite));
  catch_stop_signals();
  Progress progress;
  Ending ending;
  try {
    ending = simulate(scene, {folder.path(), o.threads, o.resume, false}, progress);
  } catch (const RunError& e) {
    const std::string checkpoint = folder.file("checkpoint.h5");
    if (!std::filesystem::exists(checkpoint)) throw;
    throw RunError(std::string(e.what()) + " The state before it is in " + checkpoint +
                   "; to go on from there: " + resume);
  }
  if (ending == Ending::stopped) {
    std::fprintf(stderr, "trackbed: stopped; go on with: %s\n", resume.c_str());
    return 128 + stop_signal();
  }
  std::printf("results in %s; trackbed report %s draws them\n", path.c_str(), path.c_str());
  return 0;
}

}  // namespace trackbed::apps
