#include "apps/trackbed/simulation/grains.h"

#include "dem/grain/library.h"

namespace trackbed::apps {

std::vector<dem::GrainShape> make_grain_library(const Scene& s,
                                                const std::function<void(double)>& progress) {
  dem::LibraryParameters p;
  p.generator = s.grains.generator;
  p.count = s.grains.library;
  p.seed = s.grains.seed;
  p.method = dem::parse_sieve_method(s.grains.sieve_method);
  return dem::make_library(p, progress);
}

dem::SieveCurve gradation_curve(const Scene& s) {
  const GradationScene& g = s.gradation;
  dem::SieveCurve curve =
      g.curve == "table" ? dem::make_curve(g.sieves, g.passing) : dem::named_curve(g.curve);
  if (curve.passing.back() < 100 && g.top_sieve > curve.sieve.back()) curve.top = g.top_sieve;
  dem::validate(curve);
  return curve;
}

std::vector<dem::GrainShape> draw_grains(const Scene& s,
                                         const std::vector<dem::GrainShape>& library, double mass,
                                         int stream) {
  dem::DrawParameters p;
  p.volume = mass / s.grains.density;
  p.seed = s.grains.seed * 1000003 + stream;
  p.tolerance = 100 * s.gradation.tolerance;
  const dem::GradationDraw draw = dem::draw_gradation(gradation_curve(s), library, p);
  std::vector<dem::GrainShape> grains;
  grains.reserve(draw.grains.size());
  for (const dem::DrawnGrain& g : draw.grains)
    grains.push_back(dem::scaled(library[g.shape], g.scale));
  return grains;
}

}  // namespace trackbed::apps
