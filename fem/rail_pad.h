// Rail pad: a spring and a dashpot side by side between the rail, where the load acts, and the
// seat of a sleeper. It has no mass, so the seat takes the rail's load as it is, and the sleeper,
// of whatever model, moves as it does without; the rail goes down further by the pad's compression
// δ,
//   k δ + c δ̇ = F.
#pragma once

namespace trackbed::fem {

struct RailPad {
  double stiffness = 0;  ///< k [N/m] of one seat; 0: no pad, its compression is 0
  double damping = 0;    ///< c [N s/m]
};

/// Compression [m] at the end of a step of dt [s] over which the force on the seat goes linearly
/// from `before` to `now` [N]: the exact answer, at any dt. `compression` is that at its start.
double pad_compression(const RailPad&, double compression, double before, double now, double dt);

/// Work [J] of the force on the pad in such a step, from `compression` to `then`: ∫ F dδ, exact.
/// What the spring, ½ k δ², does not store of it the dashpot has lost.
double pad_work(const RailPad&, double compression, double then, double before, double now,
                double dt);

}  // namespace trackbed::fem
