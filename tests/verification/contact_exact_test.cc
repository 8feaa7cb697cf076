// Overlap volumes and centroids against exact rational arithmetic: CGAL intersects the half-spaces
// of both bodies (planes through the very vertices the kernel gets), random and degenerate pairs.
#include <gtest/gtest.h>

#include "tests/verification/exact_overlap.h"

namespace trackbed::dem::test {
namespace {

// Compares for several axes; true if the pair overlaps.
bool compare(const Polyhedron& a, const Pose& pa, const Polyhedron& b, const Pose& pb,
             Random& random, double tolerance) {
  ShapeTable table;
  table.add(as_is(a)), table.add(as_is(b));
  Vec3 axis = Vec3::Zero();
  if (separating_axis(table.view(0), pa, table.view(1), pb, axis) > 0) return false;
  const Contact first = evaluate(table.view(0), pa, table.view(1), pb, axis);
  if (!first.touching) return false;
  std::vector<Plane> all = planes(a, pa), more = planes(b, pb);
  all.insert(all.end(), more.begin(), more.end());
  const Exact exact = exact_overlap(all, first.centroid);
  const double size = std::cbrt(exact.volume);
  for (int k = 0; k < 4; ++k) {
    const Contact c =
        evaluate(table.view(0), pa, table.view(1), pb, k == 0 ? axis : random.direction());
    EXPECT_NEAR(c.volume, exact.volume, tolerance * exact.volume) << a.vertices.size();
    EXPECT_LT((c.centroid - exact.centroid).norm(), tolerance * size);
  }
  return true;
}

TEST(ExactOverlap, RandomHulls) {
  Random random(21);
  int overlapping = 0;
  for (int k = 0; k < 150; ++k) {
    const Polyhedron a = random_hull(random, 6 + k % 15), b = random_hull(random, 6 + k % 11);
    const Pose pa{Mat3::Identity(), Vec3::Zero()},
        pb{Mat3::Identity(), random.uniform(0, 1.6) * random.direction()};
    overlapping += compare(a, pa, b, pb, random, 1e-10);
  }
  EXPECT_GT(overlapping, 80);
}

TEST(ExactOverlap, ShallowRandomHulls) {
  Random random(22);
  for (int k = 0; k < 100; ++k) {
    const Polyhedron a = random_hull(random, 6 + k % 15), b = random_hull(random, 6 + k % 11);
    ShapeTable table;
    table.add(as_is(a)), table.add(as_is(b));
    const Pose pa{Mat3::Identity(), Vec3::Zero()};
    // Turn b's vertices first, so that its pose is a shift.
    Pose pb = touching_pose(random, table.view(0), pa, table.view(1), 0);
    Polyhedron turned = b;
    for (Vec3& v : turned.vertices) v = pb.R * v;
    pb.R = Mat3::Identity();
    pb.x *= 1 - std::pow(10, random.uniform(-4, -2));
    compare(a, pa, turned, pb, random, 1e-10);
  }
}

// Bodies on the lattice of 1/8: coplanar faces, common edges and vertices, edges crossing edges.
TEST(ExactOverlap, LatticeBodies) {
  Random random(23);
  const auto lattice = [&random](int range) { return double(random.below(2 * range + 1)) - range; };
  int overlapping = 0;
  for (int k = 0; k < 300; ++k) {
    const auto body = [&] {
      while (true) {
        std::vector<Vec3> points;
        for (int i = 0; i < 9; ++i) points.push_back(Vec3(lattice(2), lattice(2), lattice(2)) / 8);
        try {
          return convex_hull(points);
        } catch (const std::exception&) {
        }
      }
    };
    const Polyhedron a = body(), b = k % 10 == 0 ? a : body();
    const Pose pa{Mat3::Identity(), Vec3::Zero()};
    Pose pb{Mat3::Identity(), Vec3(lattice(2), lattice(2), lattice(2)) / 8};
    if (k % 10 == 0 && k % 20 == 0) pb.x.setZero();
    if (k % 3 == 0) pb.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    overlapping += compare(a, pa, b, pb, random, 1e-10);
  }
  EXPECT_GT(overlapping, 150);
}

// Found by hard/fuzz_pairs: faces of one body that are coplanar within 1e-9 coincide within 1e-9
// with one of the other. Clipped each on its own they left a gap of 5e-5 of the overlap.
TEST(ExactOverlap, CoincidingFacesBesideNearlyCoplanarOnes) {
  const Polyhedron a = {{{-0.50000000004257927, -0.4999999996695193, -0.3749999990571482},
                         {-0.49999999917111831, -0.12500000043992771, -0.24999999965442976},
                         {-0.49999999911327214, 0.49999999955579605, 1.2804890325569847e-10},
                         {-0.37500000091804575, -0.50000000036203618, -0.50000000016162249},
                         {-0.37500000019344443, 0.24999999903577355, -0.24999999981876367},
                         {-0.12500000031419603, 0.24999999913630547, -0.37499999960590275},
                         {-1.5581043671951532e-10, 0.12499999928618602, 0.12499999931721693},
                         {0.37499999999898459, 0.12500000076075798, 0.25000000064903488}},
                        {{0, 1, 4, 3},
                         {0, 2, 1},
                         {0, 3, 7},
                         {0, 6, 2},
                         {0, 7, 6},
                         {1, 2, 4},
                         {2, 5, 4},
                         {2, 6, 7},
                         {2, 7, 5},
                         {3, 4, 5},
                         {3, 5, 7}}};
  const Polyhedron b = {{{-0.50000000036923464, -0.24999999943857967, -0.12500000014072599},
                         {-0.49999999977345516, -0.87499999983108689, 0.12499999876682194},
                         {-0.49999999962129954, -0.12500000022029301, 0.24999999917144289},
                         {-0.49999999888340629, -0.50000000015068757, -0.62500000036029002},
                         {-0.49999999844174797, -0.1249999993706542, -0.50000000028291158},
                         {-0.37499999894820385, -0.9999999998385446, 0.2500000002559265},
                         {-0.24999999970255724, -0.74999999850700583, -0.7499999999303828},
                         {-0.12499999894054084, -0.24999999885488511, 0.24999999880729623},
                         {0.1249999999639758, -0.87499999902991021, -0.25000000118904853},
                         {0.12500000111374826, -0.99999999973320641, -1.18060997089664e-09},
                         {0.24999999993933034, -0.12499999952801705, -0.12499999970663395},
                         {0.50000000075526407, -0.49999999863775108, -0.12499999973734321}},
                        {{0, 1, 2},
                         {0, 2, 4},
                         {0, 4, 3, 1},
                         {1, 3, 6},
                         {1, 5, 2},
                         {1, 6, 5},
                         {2, 5, 7},
                         {2, 7, 10},
                         {2, 10, 4},
                         {3, 4, 6},
                         {4, 10, 6},
                         {5, 6, 9},
                         {5, 9, 7},
                         {6, 8, 9},
                         {6, 10, 11},
                         {6, 11, 8},
                         {7, 9, 11},
                         {7, 11, 10},
                         {8, 11, 9}}};
  Random random(24);
  const Pose still{Mat3::Identity(), Vec3::Zero()};
  // Corners of b lie 1.4e-9 off the plane of their face.
  EXPECT_TRUE(compare(a, still, b, still, random, 1e-8));
  ShapeTable table;
  table.add(as_is(a)), table.add(as_is(b));
  for (int k = 0; k < 4; ++k) {
    const Contact c =
        evaluate(table.view(k % 2), still, table.view(1 - k % 2), still, random.direction());
    EXPECT_LT((c.force_a + c.force_b).norm(), 1e-12 * c.force_a.norm());
  }
}

// The oracle itself: the same pair from two points inside, which its dual depends on.
TEST(ExactOverlap, DoesNotDependOnThePointInside) {
  const Polyhedron a = {
      {{-0.96391484705861108, -0.080107185546795842, -0.25387202769061729},
       {-0.92912405182562452, 0.1381621367822698, -0.34298647244299807},
       {-0.71858653557553454, -0.6949058663025065, -0.027188745243465814},
       {-0.50676751107730378, 0.78592897932823502, 0.35426307903674265},
       {-0.45691082701150981, 0.083040881078467244, 0.88562786102819169},
       {-0.093960649710949182, 0.99499645385960866, -0.033962525122552073},
       {0.11280532184400006, -0.19466116651220683, 0.9743623502659462},
       {0.21261860419014733, -0.74456200397760952, -0.6327880777836129},
       {0.26702480061984596, 0.74743926898812507, -0.60830279880042359},
       {0.3639597480782259, -0.45078866160065079, -0.81506004953692124},
       {0.3880191495117527, 0.75074382381420357, 0.53462589781734693},
       {0.89698839110333162, -0.42693233216572196, 0.1146324996560497}},
      {{0, 1, 9},  {0, 2, 4},  {0, 3, 1},   {0, 4, 3},  {0, 7, 2},   {0, 9, 7},  {1, 3, 5},
       {1, 5, 8},  {1, 8, 9},  {2, 6, 4},   {2, 7, 11}, {2, 11, 6},  {3, 4, 10}, {3, 10, 5},
       {4, 6, 10}, {5, 10, 8}, {6, 11, 10}, {7, 9, 11}, {8, 10, 11}, {8, 11, 9}}};
  const Polyhedron b = {
      {{-0.12500000000204808, 0.50000000083647289, 0.37499999945199547},
       {-6.2713040316353386e-10, 0.74999999980509546, -0.12499999924586497},
       {1.2883721867140707e-11, -0.1249999993150242, -0.24999999927154815},
       {0.24999999994468899, 0.249999999080465, -0.12500000038909648},
       {0.25000000006286044, 0.5000000001466014, 0.37500000098719632},
       {0.37500000004728729, 0.74999999906007764, -0.12500000033809761}},
      {{0, 1, 2}, {0, 2, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 3, 4}, {2, 5, 3}, {3, 5, 4}}};
  Random random(25);
  const Pose still{Mat3::Identity(), Vec3::Zero()};
  ASSERT_TRUE(compare(a, still, b, still, random, 1e-10));
  ShapeTable table;
  table.add(as_is(a)), table.add(as_is(b));
  const Contact c = evaluate(table.view(0), still, table.view(1), still, Vec3::UnitZ());
  std::vector<Plane> all = planes(a, still), more = planes(b, still);
  all.insert(all.end(), more.begin(), more.end());
  const double volume = exact_overlap(all, c.centroid).volume;
  const double shifted = exact_overlap(all, c.centroid + 1e-3 * random.direction()).volume;
  EXPECT_NEAR(shifted, volume, 1e-15 * volume);
}

}  // namespace
}  // namespace trackbed::dem::test
