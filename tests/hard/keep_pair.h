// An offending pair as a scene that `trackbed run` replays.
#pragma once
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "dem/packing/packing_file.h"
#include "motion_scene.h"

namespace trackbed::dem::test {

struct PairLaw {
  std::string law = "stored_energy", round_law = "hertz_mindlin";
  double modulus = 1;    ///< [Pa]
  double stiffness = 0;  ///< of `linear` [N/m]
};

/// A twentieth of the limit of two grains that are let go where they stand [s].
inline double step_of_pair(const PackedGrains& pair, const PairLaw& law, double density) {
  Scene s(law.modulus, 0, law.law);
  s.round = make_round_forces(law.round_law, false);
  PairMaterial m = s.materials(0, 0);
  m.stiffness = law.stiffness;
  s.materials.set(0, 0, m);
  for (int i = 0; i < 2; ++i) s.add(pair.shape[i], density, pair.centre[i], pair.turn[i]);
  s.prepare();
  const double limit = measured_limit(s.bodies, s.pairs, 1).dt;
  return .05 *
         (std::isfinite(limit) ? limit : expected_limit(s.bodies, s.shapes, s.materials, {}).dt);
}

/// Writes STEM.prm, STEM.csv and STEM_shapes/, elastic and without friction.
inline void keep_pair(PackedGrains pair, const PairLaw& law, const std::string& stem) {
  namespace fs = std::filesystem;
  constexpr double kDensity = 2600;
  for (GrainShape& shape : pair.shape)
    if (!(shape.sieve_size > 0)) shape.sieve_size = std::cbrt(shape.volume);
  const DistinctShapes shapes = distinct_shapes(pair);
  fs::create_directories(stem + "_shapes");
  for (std::size_t k = 0; k < shapes.first_of.size(); ++k) {
    const ShapeFile file = shape_file(pair.shape[shapes.first_of[k]]);
    std::ofstream(stem + "_shapes/" + std::to_string(k) + file.ending) << file.text;
  }
  std::ofstream(stem + ".csv") << packing_csv_text(pair, shapes.shape_of);
  std::ofstream prm(stem + ".prm");
  prm << "set Title = Offender\n"
      << "subsection Contact\n  set Law = " << law.law << "\n  set Round law = " << law.round_law
      << "\n  set Contact modulus = " << law.modulus;
  if (law.stiffness > 0) prm << "\n  set Stiffness = " << law.stiffness;
  prm << "\n  set Restitution = 1\n  set Largest overlap = 0.5\nend\n"
      << "subsection Grains\n  set Density = " << kDensity << "\n  set Friction = 0\nend\n"
      << "subsection Numerics\n  set Time step = " << step_of_pair(pair, law, kDensity) << "\nend\n"
      << "subsection Replay\n  set Bodies = " << fs::path(stem).filename().string()
      << ".csv\nend\n";
}

}  // namespace trackbed::dem::test
