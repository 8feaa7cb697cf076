#include "apps/trackbed/simulation/export_packing.h"

#include <filesystem>

#include "apps/trackbed/files.h"
#include "apps/trackbed/simulation/saved_run.h"
#include "base/error.h"
#include "dem/packing/packing_file.h"

namespace trackbed::apps {
namespace {

// Shapes first: the table names no file that is not there.
void write_csv(const dem::PackedGrains& grains, const std::string& folder) {
  const dem::DistinctShapes distinct = dem::distinct_shapes(grains);
  const std::string shapes = folder + "/packing_shapes";
  std::error_code failed;
  std::filesystem::remove_all(shapes, failed);
  std::filesystem::create_directories(shapes, failed);
  if (failed) throw RunError(shapes + ": cannot be made: " + failed.message());
  for (std::size_t k = 0; k < distinct.first_of.size(); ++k) {
    const dem::ShapeFile file = dem::shape_file(grains.shape[distinct.first_of[k]]);
    write_aside_then_rename(shapes + "/" + std::to_string(k) + file.ending, file.text);
  }
  write_aside_then_rename(folder + "/packing.csv",
                          dem::packing_csv_text(grains, distinct.shape_of));
}

}  // namespace

std::vector<std::string> export_packing(const Scene& scene, const std::string& kept,
                                        const std::vector<std::string>& formats,
                                        const std::string& folder) {
  std::vector<std::string> files;
  if (formats.empty()) return files;
  Run run;
  run.scene = scene;
  load_run(kept, run);
  dem::PackedGrains grains = dem::packed_grains(run.world.bodies, run.world.shapes);
  const std::vector<double>& origin = scene.packing.origin;
  for (dem::Vec3& x : grains.centre) x += dem::Vec3(origin[0], origin[1], origin[2]);
  for (const std::string& format : formats) {
    files.push_back(folder + "/packing." + format);
    if (format == "csv")
      write_csv(grains, folder);
    else
      write_aside_then_rename(files.back(), format == "off" ? dem::packing_off_text(grains)
                                                            : dem::packing_vtu_text(grains));
  }
  return files;
}

}  // namespace trackbed::apps
