// `trackbed compare`: the same packing under rigid and under elastic structures, each run twice
// with a change in the last bit as noise floor; with --packings N further packings for scatter.
#include <cstdio>
#include <filesystem>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/plot_script.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/simulate.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

struct Variant {
  std::string folder;
  std::vector<std::string> set;
};

// A change of one grain's place by about one bit: what differs between the two runs after it is
// noise, not physics.
constexpr const char* kLastBit = "Numerics/Mirror noise=1e-15";

std::vector<Variant> variants(const Scene& scene, int packings) {
  const std::vector<std::string> rigid{"Sleeper/Model=rigid", "Subgrade/Model=rigid"};
  // What the scene names is what is compared; a rigid scene is compared with the default
  // structures.
  std::vector<std::string> elastic;
  if (scene.sleeper.model == "rigid") elastic.push_back("Sleeper/Model=elastic");
  if (scene.subgrade.model == "rigid") elastic.push_back("Subgrade/Model=layered_elastic");
  std::vector<Variant> list;
  const auto add = [&](const std::string& folder, std::vector<std::string> set,
                       const std::vector<std::string>& more) {
    set.insert(set.end(), more.begin(), more.end());
    list.push_back({folder, set});
  };
  add("rigid", rigid, {});
  add("elastic", elastic, {});
  add("rigid_repeat", rigid, {kLastBit});
  add("elastic_repeat", elastic, {kLastBit});
  for (int k = 2; k <= packings; ++k) {
    const std::string seed = "Grains/Seed=" + std::to_string(scene.grains.seed + k - 1);
    add("packing_" + std::to_string(k) + "/rigid", rigid, {seed});
    add("packing_" + std::to_string(k) + "/elastic", elastic, {seed});
  }
  return list;
}

}  // namespace

int compare_command(const CompareOptions& o) {
  if (o.packings < 1) throw InputError("--packings: at least 1");
  const Scene scene = read_scene(o.scene, o.set);
  const std::string path = o.output.empty() ? "results/" + scene.name + "_compare" : o.output;
  const std::vector<Variant> list = variants(scene, o.packings);
  std::vector<Scene> scenes;
  for (const Variant& v : list) {
    std::vector<std::string> set = o.set;
    set.insert(set.end(), v.set.begin(), v.set.end());
    scenes.push_back(read_scene(o.scene, set));
  }
  catch_stop_signals();
  Progress progress;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string folder = path + "/" + list[k].folder;
    const bool goes_on = o.resume && std::filesystem::exists(folder + "/checkpoint.h5");
    OutputFolder lock(
        folder, goes_on ? EarlierRun::resume
                        : (o.resume ? EarlierRun::overwrite : earlier_run(false, o.overwrite)));
    progress.note("run " + std::to_string(k + 1) + " of " + std::to_string(list.size()) + ": " +
                  list[k].folder);
    if (simulate(scenes[k], {folder, o.threads, goes_on, false}, progress) == Ending::stopped) {
      std::string resume = resume_command("compare", o.scene, path, o.set);
      if (o.packings > 1) resume += " --packings " + std::to_string(o.packings);
      std::fprintf(stderr, "trackbed: stopped; go on with: %s\n", resume.c_str());
      return 128 + stop_signal();
    }
  }
  return run_plot_script("compare.py", path);
}

}  // namespace trackbed::apps
