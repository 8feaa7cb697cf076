#include "apps/trackbed/simulation/simulate.h"

#include <filesystem>
#include <thread>

#include "apps/trackbed/files.h"
#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/grain_tests/walls.h"
#include "apps/trackbed/simulation/packing_store.h"
#include "apps/trackbed/simulation/quasi_vibration.h"
#include "apps/trackbed/simulation/results.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

Run make_run(const Scene& scene, int threads) {
  Run run;
  run.scene = scene;
  run.actors.sample = scene.packing.bays > 1;
  run.layout = sample_layout(scene);
  run.world.exchange.schedule = coupling::schedule_named(scene.numerics.exchange);
  run.world.exchange.grain_steps = scene.numerics.grain_steps;
  run.world.exchange.tolerance = scene.numerics.exchange_tolerance;
  run.threads =
      threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return run;
}

}  // namespace

Ending simulate(const Scene& scene, const SimulationOptions& options, Progress& progress) {
  const std::string& folder = options.folder;
  const std::string resolved = folder + "/scene.resolved.prm";
  if (options.resume && std::filesystem::exists(resolved) && read_text(resolved) != scene.resolved)
    throw InputError(resolved +
                     ": the scene has changed since the run was started; resume takes "
                     "the same scene and --set options");
  write_aside_then_rename(resolved, scene.resolved);

  Run run = make_run(scene, options.threads);
  run.library_progress = [&](double share) { progress.portion("grain library ", share); };
  run.folder = folder;
  const std::vector<Stage> packing = packing_stages(scene);
  const int packed = static_cast<int>(packing.size());
  RunRecords records;
  if (options.resume)
    records = load_run(folder + "/checkpoint.h5", run);
  else if (!options.packing_only && packed > 0 && take_packing(run, folder)) {
    records.rows = {Recorder::kNew, Recorder::kNew, Recorder::kNew, Recorder::kKeepAll};
    progress.note("packing " + packing_name(scene) + " taken from " + scene.packing.folder);
  }
  Recorder recorder = records.rows.empty() ? Recorder(folder) : Recorder(folder, records.rows);

  const auto finish = [&](Ending ending) {
    recorder.flush();
    write_results(run, folder);
    if (!run.scene.test.on() || options.packing_only) return ending;
    for (const std::string& line : write_grain_test(run, folder)) progress.note(line);
    if (ending == Ending::done) forget_test_bed(run);
    return ending;
  };
  if (run.stage.index < packed) {
    if (run_stages(run, packing, 0, folder, recorder, records.snapshots, progress) ==
        Ending::stopped)
      return finish(Ending::stopped);
    recorder.flush();
    keep_packing(run, folder);
    forget_trials(run);
  }
  if (options.packing_only) return finish(Ending::done);
  return finish(run_stages(run, loading_stages(scene), packed, folder, recorder, records.snapshots,
                           progress));
}

}  // namespace trackbed::apps
