// Soil that yields by Drucker and Prager (1952), integrated by return mapping with the consistent
// tangent (de Souza Neto, Perić, Owen, Computational Methods for Plasticity, 2008, section 8.3;
// boxes 8.8 to 8.10). Tension positive, p = tr(σ)/3, s = dev σ, J2 = s:s/2:
//
//   f = √J2 + η p − ξ c,   c = c0 + H ε̄p,   flow along ∂(√J2 + η̄ p)/∂σ
//   η = 6 sin φ/(√3 (3 − sin φ)), ξ = 6 cos φ/(√3 (3 − sin φ)), η̄ as η with the dilation angle ψ
//
// (cone through the compressive meridian of Mohr and Coulomb). A point remembers its plastic strain
// (6) and ε̄p. In situ σ_zz = −ρ g depth and σ_xx = σ_yy = K0 σ_zz.
#include <cmath>

#include "base/error.h"
#include "fem/subgrades/registry.h"

namespace trackbed::fem {
namespace {

constexpr double kRoot2 = 1.4142135623730951, kRoot3 = 1.7320508075688772;

double dot(const Voigt& stress, const Voigt& strain) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += stress[i] * strain[i];
  return sum;
}

class DruckerPrager final : public StressModel {
 public:
  explicit DruckerPrager(const Values& v) {
    const double young = number(v, "Modulus"), nu = number(v, "Poisson ratio");
    shear_ = young / (2 * (1 + nu)), bulk_ = young / (3 * (1 - 2 * nu));
    const double degree = std::atan(1.) / 45, phi = degree * number(v, "Friction angle"),
                 psi = degree * number(v, "Dilation angle");
    if (psi > phi)
      throw InputError("Subgrade/drucker_prager/Dilation angle = " + v.at("Dilation angle") +
                       ": at most Friction angle = " + v.at("Friction angle") + " degrees");
    eta_ = 6 * std::sin(phi) / (kRoot3 * (3 - std::sin(phi)));
    xi_ = 6 * std::cos(phi) / (kRoot3 * (3 - std::sin(phi)));
    flow_ = 6 * std::sin(psi) / (kRoot3 * (3 - std::sin(psi)));
    cohesion_ = number(v, "Cohesion"), hardening_ = number(v, "Hardening");
    density_ = number(v, "Density");
    lateral_ = number(v, "Lateral pressure");
    if (lateral_ == 0) lateral_ = nu / (1 - nu);
  }
  int history() const override { return 7; }
  double density() const override { return density_; }

  void evaluate(const StressInputs& in, StressOutputs& out) const override {
    for (std::size_t q = 0; q < in.strain.size(); ++q) {
      const double* before = &in.history[7 * q];
      double* after = &out.history[7 * q];
      const double vertical = -9.81 * density_ * in.depth[q];
      Voigt elastic, trial{lateral_ * vertical, lateral_ * vertical, vertical, 0, 0, 0};
      for (int i = 0; i < 6; ++i) elastic[i] = in.strain[q][i] - before[i];
      const double volume = elastic[0] + elastic[1] + elastic[2];
      for (int i = 0; i < 3; ++i)
        trial[i] += 2 * shear_ * (elastic[i] - volume / 3) + bulk_ * volume;
      for (int i = 3; i < 6; ++i) trial[i] += shear_ * elastic[i];
      Tangent* tangent = out.want_tangent ? &out.tangent[q] : nullptr;
      const double gained = map_back(trial, before[6], out.stress[q], tangent);

      // Plastic strain: what the stress fell short of the trial.
      Voigt flow;
      const double fell = mean(trial) - mean(out.stress[q]);
      for (int i = 0; i < 6; ++i) {
        const double difference = trial[i] - out.stress[q][i];
        flow[i] =
            i < 3 ? (difference - fell) / (2 * shear_) + fell / (3 * bulk_) : difference / shear_;
        after[i] = before[i] + flow[i];
      }
      after[6] = before[6] + gained;
      const double p = mean(out.stress[q]), j2 = second_invariant(out.stress[q], p);
      out.stored[q] = j2 / (2 * shear_) + p * p / (2 * bulk_);
      out.dissipated[q] = dot(out.stress[q], flow);
    }
  }

 private:
  static double mean(const Voigt& s) { return (s[0] + s[1] + s[2]) / 3; }
  static double second_invariant(const Voigt& s, double p) {
    double sum = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    for (int i = 0; i < 3; ++i) sum += (s[i] - p) * (s[i] - p) / 2;
    return sum;
  }

  // D = along_deviator I_dev + along_flow N⊗N + mixed (η N⊗1 + η̄ 1⊗N) + along_pressure 1⊗1, with
  // N the unit deviator of the trial stress.
  void fill(Tangent& D, double along_deviator, double along_flow, double mixed,
            double along_pressure, const Voigt& N) const {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double one_i = i < 3, one_j = j < 3;
        const double deviator = (i == j) * (i < 3 ? 1 : 0.5) - one_i * one_j / 3;
        D[6 * i + j] = along_deviator * deviator + along_flow * N[i] * N[j] +
                       mixed * (eta_ * N[i] * one_j + flow_ * one_i * N[j]) +
                       along_pressure * one_i * one_j;
      }
  }

  // Stress and tangent; returns the gain of ε̄p.
  double map_back(const Voigt& trial, double hardened, Voigt& stress, Tangent* D) const {
    const double p = mean(trial), root = std::sqrt(second_invariant(trial, p)),
                 c = cohesion_ + hardening_ * hardened;
    Voigt N{};
    if (root > 0)
      for (int i = 0; i < 6; ++i) N[i] = (trial[i] - (i < 3) * p) / (kRoot2 * root);
    stress = trial;
    if (root + eta_ * p - xi_ * c <= 0) {
      if (D) fill(*D, 2 * shear_, 0, 0, bulk_, N);
      return 0;
    }
    // To the cone's side.
    const double A = 1 / (shear_ + bulk_ * eta_ * flow_ + xi_ * xi_ * hardening_);
    const double slip = A * (root + eta_ * p - xi_ * c);
    if (root >= shear_ * slip) {
      const double share = 1 - shear_ * slip / root, pressure = p - bulk_ * flow_ * slip;
      for (int i = 0; i < 6; ++i) stress[i] = share * (trial[i] - (i < 3) * p) + (i < 3) * pressure;
      if (D)
        fill(*D, 2 * shear_ * share, 2 * shear_ * (shear_ * slip / root - shear_ * A),
             -kRoot2 * shear_ * A * bulk_, bulk_ * (1 - bulk_ * eta_ * flow_ * A), N);
      return xi_ * slip;
    }
    // To the apex p = c ξ/η; volume flows there as if ψ were φ.
    const double beta = xi_ / eta_, slope = bulk_ + beta * beta * hardening_,
                 swell = (p - beta * c) / slope;
    for (int i = 0; i < 6; ++i) stress[i] = (i < 3) * (p - bulk_ * swell);
    if (D) fill(*D, 0, 0, 0, bulk_ * (1 - bulk_ / slope), N);
    return beta * swell;
  }

  double shear_, bulk_, eta_, xi_, flow_, cohesion_, hardening_, density_, lateral_;
};

const double kMost = std::numeric_limits<double>::infinity();
const std::string kSection = "Subgrade/drucker_prager";

Parameter key(const char* name, const char* fallback, const char* unit, const char* meaning,
              double least, double most) {
  return {kSection, name, fallback, unit, meaning, ParameterKind::number, least, most, {}};
}

const RegisterSubgrade here{
    {"drucker_prager",
     "Elastic, perfectly plastic or hardening soil, √J2 + η p ≤ ξ (c + H ε̄p) with η, ξ of the "
     "friction "
     "angle and flow by the dilation angle (Drucker, Prager 1952). For settlement that stays in "
     "the "
     "soil; the stress in situ is that of its own weight.",
     {key("Depth", "1", "m", "thickness of the soil over a fixed base", 1e-3, 100),
      key("Modulus", "60e6", "Pa", "Young's modulus", 1, kMost),
      key("Poisson ratio", "0.3", "-", "Poisson's ratio", 0, 0.49),
      key("Density", "1900", "kg/m3", "density", 1, 1e5),
      key("Cohesion", "15e3", "Pa", "c0, at first", 1, kMost),
      key("Friction angle", "30", "deg", "φ", 0.1, 60),
      key("Dilation angle", "10", "deg", "ψ, at most the friction angle", 0, 60),
      key("Hardening", "0", "Pa", "H, growth of the cohesion with ε̄p", 0, kMost),
      key("Lateral pressure", "0", "-", "K0 in situ; 0 = ν/(1 − ν)", 0, 10)},
     {},
     [](const Values& values) { return std::make_shared<DruckerPrager>(values); }}};

}  // namespace
}  // namespace trackbed::fem
