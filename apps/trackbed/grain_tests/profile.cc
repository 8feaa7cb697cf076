#include "apps/trackbed/grain_tests/profile.h"

#include <algorithm>
#include <cmath>

namespace trackbed::apps {
namespace {

// Height of a convex outline's upper side at x; `none` beside it.
double upper_side(const std::vector<dem::Vec2>& outline, double x, double none) {
  double top = none;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const dem::Vec2& a = outline[k];
    const dem::Vec2& b = outline[(k + 1) % outline.size()];
    if ((a.x() - x) * (b.x() - x) > 0 || a.x() == b.x()) continue;
    top = std::max(top, a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y()));
  }
  return top;
}

}  // namespace

std::vector<ProfileSlice> heap_profile(const std::vector<dem::PlacedGrain>& grains,
                                       const dem::Vec3& period,
                                       const std::vector<dem::CuttingPlane>& planes, double low,
                                       double high, double floor, int slices, int points) {
  const double width = (high - low) / slices;
  std::vector<ProfileSlice> profile(slices);
  for (int k = 0; k < slices; ++k) profile[k].distance = low + (k + 0.5) * width;
  for (const dem::CuttingPlane& plane : planes) {
    const auto pieces = dem::section(grains, period, plane);
    for (int k = 0; k < slices; ++k) {
      double sum = 0;
      for (int i = 0; i < points; ++i) {
        const double x = low + (k + (i + 0.5) / points) * width;
        double top = floor;
        for (const dem::SectionPiece& piece : pieces) top = upper_side(piece.outline, x, top);
        sum += (top - floor) / points;
      }
      profile[k].cuts.push_back(sum);
    }
  }
  for (ProfileSlice& s : profile)
    s.height = mean_of(s.cuts, 0, static_cast<int>(s.cuts.size())).value;
  return profile;
}

Estimate slope_angle(std::vector<ProfileSlice>& profile) {
  double highest = 0;
  for (const ProfileSlice& s : profile) highest = std::max(highest, s.height);
  std::size_t first = 0;
  for (std::size_t k = 0; k < profile.size(); ++k)
    if (profile[k].height > 0.8 * highest) first = k + 1;
  std::vector<double> x, h;
  for (std::size_t k = first; k < profile.size() && profile[k].height >= 0.2 * highest; ++k)
    x.push_back(profile[k].distance), h.push_back(profile[k].height);
  if (x.size() < 3) return {};
  std::vector<double> angles;  // of each cut
  for (std::size_t cut = 0; cut < profile[first].cuts.size(); ++cut) {
    std::vector<double> own;
    for (std::size_t k = first; k < first + x.size(); ++k) own.push_back(profile[k].cuts[cut]);
    angles.push_back(-std::atan(fit_line(x, own).slope));
  }
  for (std::size_t k = first; k < first + x.size(); ++k) profile[k].fitted = true;
  return {-std::atan(fit_line(x, h).slope),
          mean_of(angles, 0, static_cast<int>(angles.size())).error};
}

}  // namespace trackbed::apps
