// `trackbed cost`: the ladders of a scene's knobs over several packings, then error against time
// and, for a tolerance, the cheapest scene that meets it, which is run as well.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/cost/study.h"
#include "apps/trackbed/csv.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/parameter_text.h"
#include "apps/trackbed/plot_script.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/signals.h"
#include "base/error.h"
#include "dem/grain/nearest_name.h"

namespace trackbed::apps {
namespace {

struct Tolerance {
  std::string quantity;
  double share;
};

Tolerance parse_tolerance(const std::string& text) {
  const auto equals = text.find('=');
  const std::string name = text.substr(0, equals), allowed = "such as settlement=5%";
  double percent = 0;
  if (equals == std::string::npos || text.back() != '%' ||
      !parse_number(text.substr(equals + 1, text.size() - equals - 2), percent) || percent <= 0)
    throw InputError("--tolerance '" + text + "': a quantity and a share of it are needed, " +
                     allowed);
  const auto names = cost_quantities();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError("--tolerance '" + text + "': unknown quantity; nearest: '" +
                     dem::nearest_name(name, names) + "'; known: " + join_names(names));
  return {name, 0.01 * percent};
}

double sum_expected(const std::vector<Job>& jobs) {
  double sum = 0;
  for (const Job& job : jobs)
    if (job.status == JobStatus::waiting) sum += job.expected;
  return sum;
}

void print_plan(const Study& study, int at_once) {
  int knob = 4, value = 5;
  for (const Variant& v : study.variants) {
    knob = std::max(knob, static_cast<int>(v.knob.size()));
    value = std::max(value, static_cast<int>(v.value.size()));
  }
  std::printf("%-*s  %-*s %6s %12s %12s\n", knob, "knob", value, "value", "runs", "packing [s]",
              "loading [s]");
  for (const Variant& v : study.variants) {
    std::printf("%-*s  %-*s ", knob, v.knob.c_str(), value, v.value.c_str());
    if (!v.left_out.empty()) {
      std::printf("left out: %s\n", v.left_out.c_str());
      continue;
    }
    const Job& job = study.jobs[v.jobs[0]];
    const bool shared = v.own && v.knob != "own";
    std::printf("%6zu %12.3g %12.3g%s", shared ? 0 : v.jobs.size(),
                study.jobs[job.packing].expected, job.expected, shared ? "  the scene's own" : "");
    if (v.set.size() > 1 && v.knob.find(':') == std::string::npos)
      for (std::size_t k = 1; k < v.set.size(); ++k) std::printf("  with %s", v.set[k].c_str());
    std::printf("\n");
  }
  const auto packings = std::count_if(study.jobs.begin(), study.jobs.end(),
                                      [](const Job& job) { return job.packing < 0; });
  const double left = sum_expected(study.jobs);
  std::printf(
      "\n%td packings and %td runs, each on one thread; %s of computing left, about %s with "
      "%d at once.\n",
      packings, static_cast<std::ptrdiff_t>(study.jobs.size()) - packings,
      duration_text(left).c_str(), duration_text(left / at_once).c_str(), at_once);
}

/// Takes up what apps/plots/cost.py has recommended; false when that is nothing or the scene.
bool take_recommendation(Study& study) {
  const std::string list = study.folder + "/recommended.txt";
  if (!std::filesystem::exists(list)) return false;
  Variant variant{"recommended", "", 0, 0, false, {}, {}, {}};
  std::ifstream in(list);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) variant.set.push_back(line);
  std::vector<std::string> set = study.set;
  set.insert(set.end(), variant.set.begin(), variant.set.end());
  write_aside_then_rename(study.folder + "/recommended.prm", read_scene(study.scene, set).resolved);
  const std::size_t before = study.jobs.size();
  add_jobs(study, variant);
  study.variants.push_back(variant);
  for (std::size_t k = before; k < study.jobs.size(); ++k) {
    std::vector<Job> one{study.jobs[k]};
    recognise_finished(one, study.folder);
    study.jobs[k] = one[0];
  }
  return true;
}

/// The same study: without its options a resumed one would be another.
int stopped(const CostOptions& o, const std::string& folder) {
  std::string command = "trackbed cost " + o.scene + " --output " + folder;
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    for (const auto& value : values) command += std::string(" ") + option + " '" + value + "'";
  };
  if (o.effects) command += " --effects";
  add("--set", o.set), add("--knobs", o.knobs), add("--pairs", o.pairs);
  add("--tolerance", o.tolerances);
  command += " --seeds " + std::to_string(o.seeds);
  if (o.threads > 0) command += " --threads " + std::to_string(o.threads);
  std::fprintf(stderr, "trackbed: stopped; go on with: %s --resume\n", command.c_str());
  return 128 + stop_signal();
}

}  // namespace

int cost_command(const CostOptions& o) {
  std::vector<Tolerance> tolerances;
  for (const auto& text : o.tolerances) tolerances.push_back(parse_tolerance(text));
  const std::string path =
      o.output.empty() ? "results/" + std::filesystem::path(o.scene).stem().string() + "_cost"
                       : o.output;
  Study study = make_study(o.scene, o.set, o.knobs, o.pairs, o.effects, o.seeds, path);
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const JobOptions options{o.scene, path, o.threads > 0 ? o.threads : cores};
  for (Variant& variant : study.variants) add_jobs(study, variant);
  if (!study.variants[0].left_out.empty()) throw InputError(study.variants[0].left_out);
  const EarlierRun mode = earlier_run(o.resume, o.overwrite);
  if (mode == EarlierRun::resume) recognise_finished(study.jobs, path);
  print_plan(study, options.at_once);
  std::fflush(stdout);
  if (o.dry_run) return 0;

  OutputFolder folder(path, mode == EarlierRun::resume ? EarlierRun::keep : mode);
  CsvWriter asked(folder.file("tolerance.csv"), {"quantity", "share"});
  for (const Tolerance& t : tolerances) asked.row({t.quantity, t.share});
  asked.flush();
  catch_stop_signals();
  Progress progress;
  const bool whole = run_jobs(study.jobs, options, progress);
  write_study(study);
  if (!whole) return stopped(o, path);
  int code = run_plot_script("cost.py", path);
  if (code != 0 || tolerances.empty() || !take_recommendation(study)) return code;
  progress.note("recommended.prm is written; it is run to see whether it keeps its promise");
  const bool checked = run_jobs(study.jobs, options, progress);
  write_study(study);
  return checked ? run_plot_script("cost.py", path) : stopped(o, path);
}

}  // namespace trackbed::apps
