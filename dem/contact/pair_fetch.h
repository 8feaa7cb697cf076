// The data of the next pairs of polyhedra, asked for before they are needed: else much of a
// contact's time is spent waiting for memory, body by body. Farther ahead they would push each other
// out again. Included by the pair loop, nowhere else.
#pragma once
#include "dem/contact/fetch.h"
#include "dem/contact/overlap_feature.h"
#include "dem/contact/pairs.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// Bodies and views of a pair of polyhedra.
[[gnu::always_inline]] inline void fetch_bodies(const Bodies& b, const ShapeTable& shapes,
                                                const Pairs& pairs, int p) {
  const int j = pairs.b[p];
  fetch(b.x[j]), fetch(b.v[j]), fetch(b.turn[j]);
  fetch_lines(&b.R[j], 2);
  // A view's first line is all that a vertex in a face or edge on edge need.
  const int lines = pairs.feature[p] ? 1 : 3;
  fetch_lines(&shapes.part(b.shape[j], pairs.part_b[p]), lines);
  fetch_lines(&shapes.part(b.shape[pairs.a[p]], pairs.part_a[p]), lines);
}

/// Its own entries: they lie in a row, but in more arrays than the processor follows by itself.
[[gnu::always_inline]] inline void fetch_entries(const Pairs& pairs, int p) {
  for (const auto* v :
       {&pairs.axis, &pairs.friction, &pairs.arm_a, &pairs.arm_b, &pairs.force, &pairs.couple})
    fetch_lines(&(*v)[p], 1);
  for (const auto* v : {&pairs.wake, &pairs.friction_stiffness, &pairs.normal_force, &pairs.energy,
                        &pairs.friction_energy, &pairs.friction_loss, &pairs.area, &pairs.depth,
                        &pairs.stiffness, &pairs.tilt_stiffness})
    fetch_lines(&(*v)[p], 1);
  for (const auto* v : {&pairs.a, &pairs.b, &pairs.part_a, &pairs.part_b, &pairs.feature,
                        &pairs.faces_a, &pairs.faces_b})
    fetch_lines(&(*v)[p], 1);
}

[[gnu::always_inline]] inline void fetch_planes(const ConvexView& v) {
  fetch_lines(v.nx, (v.faces + 7) / 8 * 4);  // y, z and the offset follow
}

// Of one body, of an overlap bounded by these faces: all planes, their corners.
[[gnu::always_inline]] inline void fetch_faces(const ConvexView& v, int faces) {
  fetch_planes(v);
  if (faces == 0 || !v.corners) return;
  fetch_lines(v.loop_begin, 1);
  for (unsigned rest = faces; rest; rest &= rest - 1)
    fetch_lines(v.corners + 24 * __builtin_ctz(rest), 3);
}

// Of one body, of a contact of which it has the vertex, the face or an edge.
[[gnu::always_inline]] inline void fetch_feature(const ConvexView& v, bool plane, bool vertex,
                                                 int i) {
  if (plane) fetch_planes(v);
  if (vertex) fetch_lines(Star(v, i).at, 2);
}

/// What its last overlap was made of: reads what fetch_bodies asked for, some pairs before.
[[gnu::always_inline]] inline void fetch_shapes(const Bodies& b, const ShapeTable& shapes,
                                                const Pairs& pairs, int p) {
  const ConvexView &va = shapes.part(b.shape[pairs.a[p]], pairs.part_a[p]).core,
                   &vb = shapes.part(b.shape[pairs.b[p]], pairs.part_b[p]).core;
  if (!pairs.feature[p]) {
    fetch_faces(va, pairs.faces_a[p]), fetch_faces(vb, pairs.faces_b[p]);
    return;
  }
  const SimpleFeature f = SimpleFeature::of(pairs.feature[p]);
  const bool of_a = f.kind == SimpleFeature::vertex_of_a,
             of_b = f.kind == SimpleFeature::vertex_of_b;
  fetch_feature(va, !of_a, !of_b, f.a), fetch_feature(vb, !of_b, !of_a, f.b);
}

}  // namespace trackbed::dem
