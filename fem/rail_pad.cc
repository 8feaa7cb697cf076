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

}  // namespace trackbed::fem
