#include "bed_file.h"

#include <fstream>

#include "base/error.h"

namespace trackbed::dem {

void write_bed(const Scene& s, const Vec3& box, double density, const std::string& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "box " << box.transpose() << "\n";
  for (int i = 0; i < s.bodies.grains; ++i) {
    const GrainShape& grain = s.shapes.shape(s.bodies.shape[i]);
    std::vector<ConvexPart> parts = grain.parts;
    if (parts.empty()) parts.push_back({grain.body});
    out << "grain " << density << " " << parts.size() << "\n";
    for (const ConvexPart& part : parts) {
      out << "part " << part.radius << " " << part.core.vertices.size() << "\n";
      for (const Vec3& v : part.core.vertices)
        out << (s.bodies.x[i] + s.bodies.R[i] * v).transpose() << "\n";
    }
  }
  if (!out.flush()) throw RunError(file + ": cannot be written");
}

}  // namespace trackbed::dem
