#include "apps/trackbed/simulation/recorder.h"

#include <algorithm>
#include <cmath>

#include "apps/trackbed/files.h"
#include "apps/trackbed/simulation/actors.h"
#include "dem/motion/energy.h"

namespace trackbed::apps {
namespace {

const std::vector<std::string> kHistory{"time_s",       "stage",
                                        "load_N",       "u_m",
                                        "kinetic_J",    "contacts",
                                        "coordination", "push_displacement_m",
                                        "push_force_N", "rail_displacement_m"};
const std::vector<std::string> kEnergy{"time_s",
                                       "kinetic_J",
                                       "gravity_J",
                                       "contact_J",
                                       "structure_J",
                                       "work_J",
                                       "dissipated_friction_J",
                                       "dissipated_local_damping_J",
                                       "dissipated_contact_damping_J",
                                       "dissipated_structure_damping_J",
                                       "dissipated_structure_integration_J",
                                       "transfer_error_J",
                                       "closure_J",
                                       "dissipated_structure_plastic_J",
                                       "dissipated_boundary_J",
                                       "dissipated_rail_pads_J"};
const std::vector<std::string> kCycles{"cycle",
                                       "time_s",
                                       "load_min_N",
                                       "load_max_N",
                                       "u_min_m",
                                       "u_max_m",
                                       "settlement_m",
                                       "stiffness_loading_N_per_m",
                                       "stiffness_unloading_N_per_m"};
const std::vector<std::string> kCompaction{"cycle",    "time_s",    "height_m", "density_kg_per_m3",
                                           "porosity", "void_ratio"};

CsvWriter open(const std::string& folder, const char* name, const std::vector<std::string>& columns,
               const std::vector<int>& rows, int k) {
  const std::string file = folder + "/" + name;
  const int count = rows.empty() ? Recorder::kNew : rows.at(k);
  if (count == Recorder::kNew) return CsvWriter(file, columns);
  if (count != Recorder::kKeepAll) return CsvWriter::resume(file, columns, count);
  const std::string text = read_text(file);
  const auto lines = std::count(text.begin(), text.end(), '\n');
  return CsvWriter::resume(file, columns, lines - 1);
}

// ΔF/Δu; empty where nothing moved.
CsvCell stiffness(double force, double displacement) {
  return displacement != 0 ? CsvCell(force / displacement) : CsvCell();
}

}  // namespace

Recorder::Recorder(const std::string& folder) : Recorder(folder, {}) {}

Recorder::Recorder(const std::string& folder, const std::vector<int>& rows)
    : history_(open(folder, "history.csv", kHistory, rows, 0)),
      energy_(open(folder, "energy.csv", kEnergy, rows, 1)),
      cycles_(open(folder, "cycles.csv", kCycles, rows, 2)),
      compaction_(open(folder, "compaction.csv", kCompaction, rows, 3)) {}

void Recorder::sample(Run& run, const Stage& stage) {
  const bool sleeper = run.actors.rigid_sleeper || run.actors.sleeper_surface >= 0;
  const CsvCell u = sleeper ? CsvCell(sleeper_displacement(run) - run.stage.u0) : CsvCell();
  history_.row({run.world.time, stage.name, run.stage.load, u,
                dem::kinetic_energy(run.world.bodies), coupling::count_contacts(run.world),
                coupling::coordination(run.world), stage.push ? CsvCell(run.stage.push) : CsvCell(),
                stage.push ? CsvCell(run.stage.push_force) : CsvCell(),
                sleeper ? CsvCell(rail_displacement(run) - run.stage.u0) : CsvCell()});
  energy(run, stage);
}

void Recorder::energy(Run& run, const Stage& stage) {
  if (!stage.ledger) return;
  const coupling::EnergyStores now = coupling::stores(run.world, step_context(run, stage).gravity);
  const coupling::EnergyFlows f = coupling::flows(run.world);
  const double open = coupling::closure(run.world.start, now, f);
  const double work = f.work + f.prescribed;
  energy_.row({run.world.time, now.kinetic, now.gravity, now.contact,
               now.structure + pads_energy(run), work + run.stage.pad_work, f.friction,
               f.local_damping, f.contact_damping, f.structure_damping, f.structure_numerical,
               f.transfer_error, open, f.structure_plastic, f.structure_boundary,
               run.stage.pad_loss});
  run.stage.work_in += std::max(0.0, work - run.stage.last_work);
  run.stage.last_work = work;
  run.stage.worst_closure = std::max(run.stage.worst_closure, std::abs(open));
  run.stage.exchange_gain = std::max(run.stage.exchange_gain, -f.transfer_error);
  run.stage.structure_gain = std::max(run.stage.structure_gain, -f.structure_numerical);
}

void Recorder::cycle(const Run& run, const Stage&, double load_start, double u_start) {
  const StageState& s = run.stage;
  cycles_.row({s.cycles, run.world.time, s.load_min, s.load_max, s.u_min, s.u_max, s.u_min,
               stiffness(s.load_max - load_start, s.u_max - u_start),
               stiffness(s.load_max - s.load_min, s.u_max - s.u_min)});
  flush();  // to be watched while the run goes on
}

void Recorder::compaction(const Run& run) {
  const double density = bed_density(run), porosity = 1 - density / run.scene.grains.density;
  compaction_.row({run.stage.cycles, run.world.time, bed_height(run), density, porosity,
                   porosity / (1 - porosity)});
  flush();
}

std::vector<int> Recorder::rows() const {
  return {static_cast<int>(history_.rows()), static_cast<int>(energy_.rows()),
          static_cast<int>(cycles_.rows()), static_cast<int>(compaction_.rows())};
}

void Recorder::flush() { history_.flush(), energy_.flush(), cycles_.flush(), compaction_.flush(); }

}  // namespace trackbed::apps
