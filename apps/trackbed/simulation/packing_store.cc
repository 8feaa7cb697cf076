#include "apps/trackbed/simulation/packing_store.h"

#include <filesystem>
#include <set>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/hash.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/saved_run.h"
#include "base/error.h"
#include "dem/packing/packing_file.h"

namespace trackbed::apps {
namespace {

constexpr const char* kVersion = "packing 10";  // raised when packings come out differently

// Parameters that a packing does not depend on, by section or by key.
bool matters(const std::string& key) {
  static const std::set<std::string> sections{"Container", "Grains",  "Gradation", "Zones",
                                              "Contact",   "Packing", "Sleeper",   "Numerics",
                                              "Subgrade",  "Output"};
  static const std::set<std::string> sleeper{
      "Sleeper/Length",   "Sleeper/Width",         "Sleeper/Height",     "Sleeper/Density",
      "Sleeper/Friction", "Sleeper/Pad thickness", "Sleeper/Pad density"};
  const std::string section = key.substr(0, key.find('/'));
  if (!sections.count(section)) return false;
  if (section == "Sleeper") return sleeper.count(key) > 0;
  if (section == "Subgrade") return key == "Subgrade/Friction";
  if (section == "Numerics")
    return key == "Numerics/Margin" || key == "Numerics/Packing margin" ||
           key == "Numerics/Time step" || key == "Numerics/Time step rule";
  if (section == "Output") return key == "Output/Samples per cycle";  // steps of a tamping cycle
  return key != "Packing/Folder" && key != "Packing/Reuse" && key != "Packing/Start from" &&
         key != "Packing/Origin" && key != "Contact/Local damping";
}

}  // namespace

std::string packing_name(const Scene& scene) {
  std::string text = kVersion;
  for (const auto& [key, value] : scene.values)
    if (matters(key)) text += "\n" + key + "=" + value;
  if (scene.test.on()) text += "\nwithout a sleeper";
  if (!scene.packing.start_from.empty()) {
    for (const double x : scene.packing.origin) text += "\n" + shortest(x);
    for (const std::string& file : dem::packing_files(scene.packing.start_from))
      text += "\n" + read_text(file);
  }
  // Stones by what they are, not by where.
  for (const std::string& file : library_parameters(scene).files) text += "\n" + read_text(file);
  return hash_name(text);
}

KeptPacking kept_packing(const Scene& scene) {
  const std::string stem = scene.packing.folder + "/" + packing_name(scene);
  return {stem + ".h5", stem + ".compaction.csv", stem + ".friction_path.csv"};
}

bool take_packing(Run& run, const std::string& folder) {
  const KeptPacking kept = kept_packing(run.scene);
  if (!run.scene.packing.reuse || !std::filesystem::exists(kept.state) ||
      !std::filesystem::exists(kept.compaction))
    return false;
  load_run(kept.state, run);
  run.world.times = {};
  run.wall_before = 0;
  write_aside_then_rename(folder + "/compaction.csv", read_text(kept.compaction));
  if (!run.path.empty() && std::filesystem::exists(kept.friction_path))
    write_aside_then_rename(folder + "/friction_path.csv", read_text(kept.friction_path));
  return true;
}

void keep_packing(Run& run, const std::string& folder) {
  const KeptPacking kept = kept_packing(run.scene);
  std::error_code failed;
  std::filesystem::create_directories(run.scene.packing.folder, failed);
  if (failed)
    throw RunError(run.scene.packing.folder +
                   ": cannot be made (Packing/Folder): " + failed.message());
  write_aside_then_rename(kept.compaction, read_text(folder + "/compaction.csv"));
  if (!run.path.empty())
    write_aside_then_rename(kept.friction_path, read_text(folder + "/friction_path.csv"));
  save_run(kept.state, run, {});
}

}  // namespace trackbed::apps
