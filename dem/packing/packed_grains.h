// Packed grains apart from any run: what is duplicated, written to files and read back.
#pragma once
#include <vector>

#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// One entry a grain: its shape, where its centroid is [m], how its principal frame is turned.
struct PackedGrains {
  std::vector<GrainShape> shape;
  std::vector<Vec3> centre;
  std::vector<Quat> turn;

  int size() const { return static_cast<int>(shape.size()); }
  void add(const GrainShape& s, const Vec3& x, const Quat& q) {
    shape.push_back(s), centre.push_back(x), turn.push_back(q);
  }
};

PackedGrains packed_grains(const Bodies&, const ShapeTable&);

/// Bed over a flat floor in a container of constant cross-section.
struct BedMeasure {
  double solid = 0;     ///< volume of all grains [m3]
  double height = 0;    ///< [m]
  double porosity = 1;  ///< [-]
};

/// The height is twice that of the centre of volume above the floor: exact for a uniform bed, and
/// with no say in where a rough top ends. A top that is uneven by s (standard deviation) reads
/// s^2/height too high. Falls whenever the grains lose height, which is what makes a search on it
/// well behaved. `area` of the cross-section [m2], `floor` its height [m].
BedMeasure measure_bed(const Bodies&, const ShapeTable&, double area, double floor);

}  // namespace trackbed::dem
