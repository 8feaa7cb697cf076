#include "dem/packing/duplicate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "dem/contact/pairs.h"
#include "dem/grain/random.h"
#include "dem/packing/lower.h"

namespace trackbed::dem {
namespace {

void mirror_solid(Polyhedron& solid, int axis) {
  for (Vec3& p : solid.vertices) p[axis] = -p[axis];
  for (auto& face : solid.faces) std::reverse(face.begin(), face.end());
}

GrainShape mirrored(GrainShape s, int axis) {
  mirror_solid(s.body, axis);
  for (ConvexPart& part : s.parts) mirror_solid(part.core, axis);
  s.origin = Vec3::Zero(), s.turn = Quat::Identity();  // there is no pose of a mirror image
  return s;
}

// About the vertical through `centre`.
void turn_all(PackedGrains& grains, const Vec3& centre, const Quat& q) {
  for (int i = 0; i < grains.size(); ++i) {
    const Vec3 arm = grains.centre[i] - centre;
    grains.centre[i] = centre + q * arm;
    grains.turn[i] = (q * grains.turn[i]).normalized();
  }
}

// One of the ways in which the box takes the sample in again.
void vary(PackedGrains& grains, const LayerSettings& s, int way, Random& random) {
  Vec3 centre = 0.5 * (s.low + s.high);
  centre.z() = 0;
  const Quat half(0, 0, 0, 1), quarter(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  if (way & 4) turn_all(grains, centre, quarter);
  if ((way & 3) == 1) turn_all(grains, centre, half);
  if ((way & 3) >= 2)
    for (int i = 0; i < grains.size(); ++i) mirror(grains, i, (way & 3) - 2, centre[(way & 3) - 2]);
  for (int k = 0; k < 2; ++k) {
    if (s.period[k] <= 0) continue;
    const double shift = random.uniform(0, s.period[k]);
    for (Vec3& x : grains.centre) {
      x[k] += shift;
      if (x[k] > s.high[k]) x[k] -= s.period[k];
    }
  }
}

// A block of grains above a layer, as the contact kernel sees them.
struct Above {
  const PackedGrains &block, &below;
  Vec3 period;
  ShapeTable upper, lower;

  Above(const PackedGrains& b, const PackedGrains& l, const Vec3& p)
      : block(b), below(l), period(p) {
    for (const GrainShape& g : block.shape) upper.add(g);
    for (const GrainShape& g : below.shape) lower.add(g);
  }
  static Pose pose(const PackedGrains& g, int i, const Vec3& shift) {
    return {g.turn[i].toRotationMatrix(), g.centre[i] + shift};
  }
  // Calls f with the pairs whose balls may meet on the way down.
  template <class F>
  void for_each_pair(double way, F&& f) const {
    for (int i = 0; i < block.size(); ++i)
      for (int j = 0; j < below.size(); ++j) {
        const Vec3 shift = nearest_image(block.centre[i], below.centre[j], period);
        const Vec3 apart = below.centre[j] + shift - block.centre[i];
        const double reach = block.shape[i].radius + below.shape[j].radius;
        if (apart.head<2>().squaredNorm() < reach * reach && -apart.z() <= way + reach)
          f(i, j, shift);
      }
  }
  // How far the block can go down before one of its grains touches, at most `limit`.
  double fall(double limit) const {
    for_each_pair(limit, [&](int i, int j, const Vec3& shift) {
      limit = std::min(limit, free_fall(upper.view(i), pose(block, i, Vec3::Zero()), lower.view(j),
                                        pose(below, j, shift), limit));
    });
    return limit;
  }
  std::vector<char> overlapping() const {
    std::vector<char> out(block.size(), 0);
    for_each_pair(0, [&](int i, int j, const Vec3& shift) {
      if (out[i]) return;
      Vec3 axis = below.centre[j] + shift - block.centre[i];
      out[i] = separating_axis(upper.view(i), pose(block, i, Vec3::Zero()), lower.view(j),
                               pose(below, j, shift), axis) <= 0;
    });
    return out;
  }
};

std::pair<double, double> extent(const PackedGrains& grains) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int i = 0; i < grains.size(); ++i)
    for (const Vec3& p : grains.shape[i].body.vertices) {
      const double z = (grains.centre[i] + grains.turn[i] * p).z();
      low = std::min(low, z), high = std::max(high, z);
    }
  return {low, high};
}

}  // namespace

void mirror(PackedGrains& grains, int i, int axis, double at) {
  // M R v + M x = (M R M)(M v) + M x: a mirrored body in a proper rotation.
  Mat3 M = Mat3::Identity();
  M(axis, axis) = -1;
  grains.shape[i] = mirrored(grains.shape[i], axis);
  grains.turn[i] = Quat(M * grains.turn[i].toRotationMatrix() * M).normalized();
  grains.centre[i][axis] = 2 * at - grains.centre[i][axis];
}

LayeredBed duplicate_layers(const PackedGrains& sample, const LayerSettings& s) {
  if (s.layers < 1) throw InputError("at least one layer is needed");
  if (sample.size() == 0) throw InputError("a sample without grains cannot be duplicated");
  if (s.spacing < 0 || s.sink < 0)
    throw InputError("the spacing and the sink of layers must not be negative");
  const Vec3 size = s.high - s.low;
  const bool square = std::abs(size.x() - size.y()) < 1e-9 * size.x() && s.period.isZero();
  const int ways = square ? 8 : 4;
  Random random(s.seed);
  LayeredBed result{sample, std::vector<int>(sample.size(), 0), {}};
  PackedGrains last = sample;  // nothing passes through it to the layers below
  double raised = 0;
  const auto [low, high] = extent(sample);
  for (int k = 1; k < s.layers; ++k) {
    PackedGrains block = sample;
    if (s.varied) vary(block, s, k % ways, random);
    const auto raise = [&](double way) {
      for (Vec3& x : block.centre) x.z() += way;
      raised += way;
    };
    if (s.spacing > 0) {
      raised = 0;
      raise(k * s.spacing);
    } else {
      const double clear = high - low + s.clearance, before = raised;
      raised = 0;
      raise(before + clear);
      raise(s.clearance - s.sink - Above(block, last, s.period).fall(clear + high - low));
    }
    const std::vector<char> out = Above(block, last, s.period).overlapping();
    PackedGrains kept;
    for (int i = 0; i < block.size(); ++i) {
      if (out[i]) {
        result.left_out.push_back(block.shape[i]);
        continue;
      }
      kept.add(block.shape[i], block.centre[i], block.turn[i]);
      result.bed.add(block.shape[i], block.centre[i], block.turn[i]);
      result.layer.push_back(k);
    }
    last = std::move(kept);
  }
  return result;
}

PackedGrains duplicate_along(const PackedGrains& sample, int axis, double period, int copies) {
  if (copies < 1) throw InputError("at least one copy is needed");
  if (axis < 0 || axis > 1 || !(period > 0))
    throw InputError("a sample is repeated along a direction in which it is periodic");
  PackedGrains bed = sample;
  for (int k = 1; k < copies; ++k)
    for (int i = 0; i < sample.size(); ++i) {
      Vec3 x = sample.centre[i];
      x[axis] += k * period;
      bed.add(sample.shape[i], x, sample.turn[i]);
    }
  return bed;
}

}  // namespace trackbed::dem
