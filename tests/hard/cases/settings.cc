#include <algorithm>

#include "dem/contact/pair_forces.h"
#include "dem/contact/round_forces.h"
#include "dem/grain/voronoi.h"
#include "hard_case.h"

namespace trackbed::hard {

dem::Polyhedron solid(const std::string& name, double size) {
  using dem::Vec3;
  if (name == "cube") return dem::make_box({size, size, size});
  if (name == "plate") return dem::make_box({size, size, .1 * size});
  if (name == "needle") return dem::make_box({size, .05 * size, .05 * size});
  if (name == "tetrahedron")
    return dem::convex_hull({Vec3(1, 1, 1) * size / 2, Vec3(1, -1, -1) * size / 2,
                             Vec3(-1, 1, -1) * size / 2, Vec3(-1, -1, 1) * size / 2});
  dem::VoronoiParameters v;
  v.count = 5;
  dem::Polyhedron body = dem::voronoi_grains(v)[2];
  for (Vec3& p : body.vertices) p *= size;
  return body;
}

std::vector<Group> groups() {
  return {{"Edges and corners", edge_cases()},
          {"Faces, at rest, on a path", rest_cases()},
          {"Round grains", round_cases()},
          {"Faces of dilated grains", flat_cases()},
          {"Impacts and starts", impact_cases()},
          {"Thin solids, spare corners, one in another", solid_cases()},
          {"Over facets", facet_cases()},
          {"The step", step_cases()},
          {"The same bits", saved_cases()},
          {"Grains on elements", coupled_cases()},
          {"Structures", structure_cases()}};
}

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const Group& g : groups()) all.insert(all.end(), g.cases.begin(), g.cases.end());
  return all;
}

std::vector<Setting> settings(const Case& c) {
  if (c.over == Over::once) return {{"", "", .05, "", 1}};
  std::vector<Setting> list;
  const std::vector<double> shares =
      c.shares ? std::vector<double>{.05, .2, .5, .9} : std::vector<double>{.05};
  if (c.over == Over::schedules) {
    for (const double share : shares) {
      list.push_back({"cube", "stored_energy", share, "predicted", 1});
      for (const char* name : {"explicit", "iterated", "lagged"})
        list.push_back({"cube", "stored_energy", share, name, 1});
      for (const int n : {2, 5, 10, 30, 100})
        list.push_back({"cube", "stored_energy", share, "several_steps", n});
    }
    return list;
  }
  if (c.over == Over::pair_laws) {
    for (const auto& law : dem::pair_law_names())
      for (const double share : shares) list.push_back({"", law, share, "", 1});
    return list;
  }
  if (c.over == Over::dilated) {
    std::vector<std::string> laws = dem::round_law_names();
    std::stable_partition(laws.begin(), laws.end(),
                          [](const std::string& law) { return law == "hertz_flat"; });
    for (const auto& law : laws)
      for (const double share : shares) list.push_back({"dilated", law, share, "", 1});
    return list;
  }
  std::vector<std::string> shapes;
  if (c.over != Over::round_shapes) shapes = {"cube", "plate", "needle"};
  if (c.over == Over::shapes || c.over == Over::all_shapes)
    shapes.insert(shapes.end(), {"tetrahedron", "voronoi"});
  for (const auto& shape : shapes)
    for (const auto& law : dem::pair_law_names())
      for (const double share : shares) list.push_back({shape, law, share, "", 1});
  if (c.over == Over::round_shapes || c.over == Over::all_shapes || c.over == Over::level_shapes)
    for (const char* shape : {"sphere", "clump", "dilated"})
      for (const auto& law : dem::round_law_names()) {
        if (law == "hertz_flat" && shape != std::string("dilated")) continue;  // Hertz
        for (const double share : shares) list.push_back({shape, law, share, "", 1});
      }
  return list;
}

}  // namespace trackbed::hard
