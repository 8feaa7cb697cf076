// Shao, Lian, Yang 2017, section 1: the paper's two examples of why volume and the least square do
// not give a grain's sieve size, 62 x 62 x 100 mm and 64 x 4 x 100 mm, by every method.
// usage: shao_boxes_study FOLDER; writes FOLDER/sizes.csv and outlines.csv
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "dem/grading/shadow.h"
#include "dem/grading/sieve_size.h"

namespace {

using namespace trackbed::dem;

void write(const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream sizes(folder + "/sizes.csv"), outlines(folder + "/outlines.csv");
  sizes << "grain,method,size_mm,passes_63\n";
  outlines << "grain,hole_mm,x_mm,y_mm\n";
  for (const Vec3& edges : {Vec3(62, 62, 100), Vec3(64, 4, 100)}) {
    char name[64];
    std::snprintf(name, sizeof name, "%g x %g x %g", edges.x(), edges.y(), edges.z());
    const Polyhedron box = make_box(edges);
    for (const std::string& method : sieve_method_names()) {
      const double size = sieve_size(box, parse_sieve_method(method));
      sizes << name << ',' << method << ',' << size << ',' << (size <= 63 ? "yes" : "no") << '\n';
      std::printf("%-14s %-13s %7.3f mm  %s the 63 mm sieve\n", name, method.c_str(), size,
                  size <= 63 ? "passes" : "is stopped by");
    }
    // The shadow as it lies in its least hole, along the hole's sides.
    const ExactSieveSize exact = exact_sieve_size(box);
    std::vector<Vec3> slab;  // shadow() has axes of its own; along z they are those of the body
    for (const Vec3& v : box.vertices)
      for (double z : {0., 1.}) slab.emplace_back(exact.u.dot(v), exact.v.dot(v), z);
    for (const Vec2& p : shadow(convex_hull(slab), Vec3::UnitZ()))
      outlines << name << ',' << exact.size << ',' << p.x() << ',' << p.y() << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: shao_boxes_study FOLDER\n");
    return 2;
  }
  try {
    write(argv[1]);
  } catch (const trackbed::InputError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
