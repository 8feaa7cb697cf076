#include "fem/rail_pad.h"

#include <cmath>

namespace trackbed::fem {

double pad_compression(const RailPad& pad, double compression, double before, double now,
                       double dt) {
  if (pad.stiffness == 0) return 0;
  if (pad.damping == 0) return now / pad.stiffness;
  if (dt == 0) return compression;
  // A force that grows evenly is followed τ = c/k late; what the start had besides dies away.
  const double tau = pad.damping / pad.stiffness;
  const double late = tau * (now - before) / dt;
  const double rest = compression - (before - late) / pad.stiffness;
  return (now - late) / pad.stiffness + rest * std::exp(-dt / tau);
}

double pad_work(const RailPad& pad, double compression, double then, double before, double now,
                double dt) {
  if (pad.stiffness == 0 || dt == 0) return 0;
  // By parts, ∫ F dδ = [F δ] − Ḟ ∫ δ dt, and k ∫ δ dt = ∫ F dt − c Δδ.
  const double k_sum = (before + now) / 2 * dt - pad.damping * (then - compression);
  return now * then - before * compression - (now - before) / dt * k_sum / pad.stiffness;
}

}  // namespace trackbed::fem
