// The energy ledger of a run: where every joule of the loads' work went. Stored energies are
// functions of the state, computed afresh; work and dissipation are sums over the steps. So
//   closure = (stored now - stored at start) - work + dissipated + transfer error
// is a true test of grains, contacts and the exchange: it is zero only if these conserve energy.
// What a structure's time integration takes out is what its own books lack, so that this sum cannot
// show it: structure_numerical is looked at for itself, as transfer_error is. Below zero they made
// energy.
#pragma once

namespace trackbed::coupling {

/// Sums since the start of the ledger [J].
struct EnergyFlows {
  double work = 0;                 ///< of outer loads, on bodies and on structures
  double prescribed = 0;           ///< of what holds prescribed motions
  double friction = 0;             ///< dissipated
  double local_damping = 0;        ///< dissipated
  double contact_damping = 0;      ///< dissipated, dashpots of contacts
  double structure_damping = 0;    ///< dissipated, Rayleigh and the dashpots of point beds
  double structure_boundary = 0;   ///< dissipated in dashpots of boundaries, absorbing ones too
  double structure_plastic = 0;    ///< dissipated in materials with history
  double structure_numerical = 0;  ///< taken out by the structures' time integration
  double transfer_error = 0;  ///< work of the grains on the predicted surface less the work the
                              ///< structure received: energy lost (+) or made (-) by prediction
};

/// Stored in the state [J].
struct EnergyStores {
  double kinetic = 0, gravity = 0;
  double contact = 0;    ///< normal and tangential, all contacts
  double structure = 0;  ///< strain + kinetic + gravity of the structures
  double total() const { return kinetic + gravity + contact + structure; }
};

/// What does not add up [J]; > 0: energy was created.
inline double closure(const EnergyStores& start, const EnergyStores& now, const EnergyFlows& f) {
  return now.total() - start.total() - f.work - f.prescribed + f.friction + f.local_damping +
         f.contact_damping + f.structure_damping + f.structure_boundary + f.structure_plastic +
         f.structure_numerical + f.transfer_error;
}

}  // namespace trackbed::coupling
