#include "dem/packing/packed_grains.h"

namespace trackbed::dem {

PackedGrains packed_grains(const Bodies& b, const ShapeTable& shapes) {
  PackedGrains grains;
  for (int i = 0; i < b.grains; ++i) grains.add(shapes.shape(b.shape[i]), b.x[i], b.q[i]);
  return grains;
}

BedMeasure measure_bed(const Bodies& b, const ShapeTable& shapes, double area, double floor) {
  BedMeasure m;
  double moment = 0;
  for (int i = 0; i < b.grains; ++i) {
    const double volume = shapes.shape(b.shape[i]).volume;
    m.solid += volume;
    moment += volume * (b.x[i].z() - floor);
  }
  if (m.solid <= 0) return m;
  m.height = 2 * moment / m.solid;
  m.porosity = 1 - m.solid / (area * m.height);
  return m;
}

}  // namespace trackbed::dem
