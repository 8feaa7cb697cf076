#include "apps/trackbed/simulation/results.h"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/decide.h"
#include "apps/trackbed/effects.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/simulation/bearing.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/measures.h"
#include "apps/trackbed/simulation/zones.h"
#include "fem/modal_structure.h"

namespace trackbed::apps {
namespace {

void write_gradation(const Run& run, const std::string& file) {
  const dem::SieveCurve curve = gradation_curve(run.scene);
  std::vector<double> sizes, volumes;
  for (int i = 0; i < run.world.bodies.grains; ++i) {
    if (run.world.bodies.material[i] == kCoarseGrain) continue;  // not of this curve
    const dem::GrainShape& g = run.world.shapes.shape(run.world.bodies.shape[i]);
    sizes.push_back(g.sieve_size), volumes.push_back(g.volume);
  }
  const std::vector<double> achieved = dem::passing_percent(sizes, volumes, curve.sieve);
  CsvWriter csv(file, {"sieve_m", "target_percent", "achieved_percent", "band_min_percent",
                       "band_max_percent"});
  for (std::size_t k = 0; k < curve.sieve.size(); ++k) {
    const bool band = !curve.band_min.empty();
    csv.row({curve.sieve[k], curve.passing[k], achieved[k],
             band ? CsvCell(curve.band_min[k]) : CsvCell(),
             band ? CsvCell(curve.band_max[k]) : CsvCell()});
  }
  csv.flush();
}

// Grains and mass of each class of the curve, the two open ones at its ends included.
void write_classes(const Run& run, const std::string& file) {
  const dem::Bodies& b = run.world.bodies;
  const auto classes = dem::sieve_classes(gradation_curve(run.scene));
  std::vector<int> count(classes.size(), 0);
  std::vector<double> mass(classes.size(), 0.0);
  double total = 0;
  for (int i = 0; i < b.grains; ++i) {
    const double size = run.world.shapes.shape(b.shape[i]).sieve_size;
    std::size_t k = 0;  // sizes (low, high]; the last class takes the rest
    while (k + 1 < classes.size() && size > classes[k].high) ++k;
    ++count[k], mass[k] += b.mass[i], total += b.mass[i];
  }
  CsvWriter csv(file, {"low_m", "high_m", "target_percent", "achieved_percent", "grains"});
  for (std::size_t k = 0; k < classes.size(); ++k)
    csv.row({classes[k].low, classes[k].high, classes[k].percent,
             total > 0 ? CsvCell(100 * mass[k] / total) : CsvCell(), count[k]});
  csv.flush();
}

void write_grains(const Run& run, const std::string& file) {
  const dem::Bodies& b = run.world.bodies;
  CsvWriter csv(file, {"grain", "shape", "sieve_m", "volume_m3", "mass_kg", "largest_force_N"});
  for (int i = 0; i < b.grains; ++i) {
    const dem::GrainShape& g = run.world.shapes.shape(b.shape[i]);
    const bool kept = i < static_cast<int>(run.stage.grain_force.size());
    csv.row(
        {i, b.shape[i], g.sieve_size, g.volume, b.mass[i], kept ? run.stage.grain_force[i] : 0.0});
  }
  csv.flush();
}

void write_timing(const Run& run, const std::string& file) {
  const coupling::StepTimes& t = run.world.times;
  const std::vector<std::pair<const char*, double>> parts{{"grain contacts", t.grain_contacts},
                                                          {"surface contacts", t.surface_contacts},
                                                          {"structures", t.structures},
                                                          {"candidates", t.candidates},
                                                          {"motion", t.motion}};
  double known = 0;
  for (const auto& p : parts) known += p.second;
  CsvWriter csv(file, {"stage", "calls", "seconds", "share"});
  const double total = std::max(wall_time(run), known);
  for (const auto& [name, seconds] : parts) csv.row({name, t.steps, seconds, seconds / total});
  csv.row({"set-up, monitors, output", 1, total - known, (total - known) / total});
  csv.flush();
}

// What the reduction of a structure leaves out.
void report_reduction(const coupling::Surface& surface, CsvWriter& csv) {
  const auto* body = dynamic_cast<const fem::ModalStructure*>(surface.structure.get());
  if (!body || !body->model().report) return;
  const fem::ReductionReport& r = *body->model().report;
  const std::string of = " of the reduced " + surface.patch.name;
  csv.row({"full unknowns" + of, r.unknowns, "-", "of the body that was reduced"});
  csv.row({"frequency error" + of, r.largest_frequency_error, "-",
           "largest of its first elastic frequencies against the full body's"});
  csv.row({"pressure error" + of, r.pressure_error, "-",
           "static deflection under even pressure that it lacks as a share of the full body's"});
  csv.row({"node error" + of, r.node_error, "-",
           "the same under a force on one node in the middle: the local dent"});
}

void write_summary(const Run& run, const std::string& file) {
  const coupling::World& w = run.world;
  const StageState& s = run.stage;
  CsvWriter csv(file, {"quantity", "value", "unit", "meaning"});
  const auto row = [&](const char* quantity, const CsvCell& value, const char* unit,
                       const char* meaning) {
    csv.row({quantity, value, unit, meaning});
  };
  const double mass =
      std::accumulate(w.bodies.mass.begin(), w.bodies.mass.begin() + w.bodies.grains, 0.0);
  row("grains", w.bodies.grains, "-", "grains in the bed");
  row("grain mass", mass, "kg", "of all grains");
  row("contacts", coupling::count_contacts(w), "-", "touching at the end");
  row("coordination", coupling::coordination(w), "-", "mean contacts per grain at the end");
  row("contact modulus", run.scene.contact.modulus, "Pa", "softer than rock: larger overlaps");
  row("largest overlap", s.largest_overlap, "-",
      "depth over the smaller grain's size, since seating");
  row("time step share", s.largest_step_share, "-",
      "largest since seating, of the measured stability limit");
  const auto stages = packing_stages(run.scene);
  for (std::size_t k = 0; k < std::min(stages.size(), s.unrest.size()); ++k) {
    const bool shaken = k + 1 < stages.size() && !stages[k + 1].until_quiet;  // no matter then
    if (stages[k].until_quiet && !shaken)
      csv.row({"unrest of " + stages[k].name, s.unrest[k], "-",
               "at its end, over what Packing/Quiet (and Unbalanced force) allows"});
  }
  row("closure", s.work_in > 0 ? CsvCell(s.worst_closure / s.work_in) : CsvCell(), "-",
      "largest energy not accounted for, over the work put in while loading");
  row("closure tolerance", run.scene.numerics.closure, "-",
      stores_energy(run.scene) ? "stated in the scene"
                               : "stated in the scene; the contact law stores no energy, so that "
                                 "only exchange and structures are held to it");
  row("exchange gain", s.work_in > 0 ? CsvCell(s.exchange_gain / s.work_in) : CsvCell(), "-",
      "largest energy that the exchange made, over the work put in while loading");
  if (run.scene.loading.push != "none")
    row("push stiffness", s.push_stiffness, "N/m", "of the actuator, as its step allowed");
  row("structure gain", s.work_in > 0 ? CsvCell(s.structure_gain / s.work_in) : CsvCell(), "-",
      "largest energy that the structures' time integration made, over the same");
  for (const coupling::Surface& surface : w.surfaces)
    csv.row({"unknowns of the " + surface.patch.name, surface.structure->unknowns(), "-",
             "finite element degrees of freedom"});
  for (const coupling::Surface& surface : w.surfaces) report_reduction(surface, csv);
  row("steps", w.times.steps, "-", "time steps done");
  row("time step", w.times.steps ? CsvCell(w.time / static_cast<double>(w.step)) : CsvCell(), "s",
      "mean over the run");
  row("wall time", wall_time(run), "s", "of this run, all its parts if it was resumed");
  row("threads", run.threads, "-", "used for the grains");
  csv.flush();
}

// push.csv: the lines of history.csv in which the sleeper was pushed.
void write_push(const std::string& history, const std::string& file) {
  std::istringstream lines(read_text(history));
  CsvWriter csv(file, {"time_s", "displacement_m", "force_N", "load_N"});
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) out.push_back(cell);
    return out;
  };
  std::string line;
  std::getline(lines, line);
  const auto names = cells(line);
  const auto column = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  const auto time = column("time_s"), stage = column("stage"), load = column("load_N"),
             u = column("push_displacement_m"), f = column("push_force_N");
  while (std::getline(lines, line)) {
    const auto row = cells(line);
    if (row.size() == names.size() && row[stage] == "push")
      csv.row({row[time], row[u], row[f], row[load]});
  }
  csv.flush();
}

}  // namespace

void write_results(const Run& run, const std::string& folder) {
  write_gradation(run, folder + "/gradation.csv");
  write_classes(run, folder + "/classes.csv");
  write_measures(run, folder);
  write_grains(run, folder + "/grains.csv");
  write_timing(run, folder + "/timing.csv");
  write_summary(run, folder + "/summary.csv");
  write_effects(run.scene, folder + "/effects.csv");
  if (run.scene.loading.push != "none") write_push(folder + "/history.csv", folder + "/push.csv");
  if (run.scene.zones.use) write_zones(run, folder + "/zones.csv");
  if (run.stage.pressure_samples > 0) write_pressure(run, folder + "/pressure.csv");
}

}  // namespace trackbed::apps
