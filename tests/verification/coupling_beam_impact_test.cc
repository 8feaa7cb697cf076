// A sphere dropped on the middle of a simply supported beam: Hertz's contact and the beam's
// vibration together (Timoshenko 1913, Zeitschrift für Mathematik und Physik 62:198). Expected are
// the solutions of his integral equation, found elsewhere and not with this code.
#include <gtest/gtest.h>

#include "coupling_scene.h"
#include "dem/grain/parts.h"
#include "fem/beam.h"
#include "fem/reduction.h"

namespace trackbed::coupling {
namespace {

constexpr double kYoung = 215.746e9, kPoisson = .3, kDensity = 7960;
constexpr double kLength = .1535, kSide = .01, kRadius = .01, kSpeed = .01;

struct Impact {
  double force = 0, peak_time = 0, end = 0, rebound = 0, momentum = 0;
};

// The sphere's dent is Hertz's, both sides elastic. The beam's own dent under a contact on faces as
// wide as the section is F/(E side), 1/200 of it: counted once in effect.
Impact drop_on(std::unique_ptr<fem::Structure> beam, double dt) {
  World w;
  w.materials = dem::PairMaterials(1);
  dem::PairMaterial m;
  m.modulus = kYoung / (2 * (1 - kPoisson * kPoisson));
  w.materials.set(0, 0, m);
  w.pair_forces = dem::make_pair_forces("stored_energy", false);
  w.patch_forces = dem::make_patch_forces("stored_energy", false);
  w.round_forces = dem::make_round_forces("hertz_mindlin", false);
  w.round_patch_forces = dem::make_round_patch_forces("hertz_mindlin", false);
  dem::add_grain(w.bodies, w.shapes, w.shapes.add(dem::sphere_shape(kRadius)), 0, kDensity,
                 {0, 0, kRadius + 1e-15}, Quat::Identity(), dem::kFree);
  w.surfaces.push_back(make_surface("beam", 0, .002, 0, Vec3::Zero(), std::move(beam)));
  w.bodies.v[0] = {0, 0, -kSpeed};
  const dem::StepContext c = context(dt, Vec3::Zero());
  start(w, c);
  Impact out;
  const double mass = w.bodies.mass[0];
  double impulse = 0;
  for (int k = 1; k * dt < 200e-6; ++k) {
    run(w, c, 1);
    const double force = w.bodies.force[0].z();
    impulse += force * dt;
    if (force > out.force) out.force = force, out.peak_time = k * dt;
    if (force > 0) out.end = (k + 1) * dt;
    if (force == 0 && out.force > 0) break;
  }
  out.rebound = w.bodies.v[0].z();
  out.momentum = std::abs(mass * (out.rebound + kSpeed) / impulse - 1);
  return out;
}

void expect_timoshenko(const Impact& i, double within) {
  std::printf("F %.4f N at %.2f us, ends %.2f us, rebound %.4e m/s\n", i.force, 1e6 * i.peak_time,
              1e6 * i.end, i.rebound);
  EXPECT_NEAR(i.force, 4.9771, within * 4.9771);
  EXPECT_NEAR(i.peak_time, 72.55e-6, within * 72.55e-6);
  EXPECT_NEAR(i.end, 156.4e-6, within * 156.4e-6);
  EXPECT_NEAR(i.rebound, 3.0232e-3, within * 3.0232e-3);
  EXPECT_LT(i.momentum, 1e-3);
}

fem::BeamParameters line(bool shear_rigid) {
  fem::BeamParameters p;
  p.low_x = -kLength / 2, p.high_x = kLength / 2;
  p.width = p.height = kSide, p.base = -kSide;
  p.elements = 31;  // the sphere lands on the middle one's diagonal
  p.cells_y = p.cells_z = 1;
  p.young = kYoung, p.poisson = kPoisson, p.density = kDensity;
  p.shear_rigid = shear_rigid;
  p.supported = true;
  return p;
}

// Its ends slide on stiff beds: free to turn, held up and down.
fem::ElasticBodyParameters solid() {
  fem::ElasticBodyParameters p;
  p.mesh.corner = {-kLength / 2, -kSide / 2, -kSide};
  p.mesh.lengths = {kLength, kSide, kSide};
  p.mesh.elements = {31, 1, 2};
  fem::Material m;
  m.name = "steel", m.young = kYoung, m.poisson = kPoisson, m.density = kDensity;
  p.materials = {m};
  p.mass = fem::Mass::consistent;
  p.newmark = true;
  p.contact = {"top"};
  for (const char* end : {"x_min", "x_max"}) {
    fem::Bed bed;
    bed.boundary = end;
    bed.shear_stiffness = 1e14;
    p.beds.push_back(bed);
  }
  return p;
}

TEST(TimoshenkoImpact, slender_beam) {
  expect_timoshenko(drop_on(fem::make_beam(line(true)), 1e-7), .01);
}

TEST(TimoshenkoImpact, shear_soft_beam) {
  expect_timoshenko(drop_on(fem::make_beam(line(false)), 1e-7), .03);
}

TEST(TimoshenkoImpact, solid_in_three_dimensions) {
  expect_timoshenko(drop_on(std::make_unique<fem::ElasticBody>(solid()), 1e-7), .03);
}

TEST(TimoshenkoImpact, condensed_solid) {
  expect_timoshenko(drop_on(fem::reduced_body(solid(), fem::Reduction::condensed, 20), 1e-7), .03);
}

}  // namespace
}  // namespace trackbed::coupling
