// Command line of `trackbed`. Exit codes: 0 success, 1 a run that failed, 2 wrong usage or input.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>

#include "apps/trackbed/commands.h"
#include "base/error.h"
#include "base/prepare_process.h"
#include "dem/grain/nearest_name.h"
#include "fem/session.h"

namespace {

using namespace trackbed::apps;

constexpr int failed = 1;
constexpr int wrong_input = 2;

void add_scene(CLI::App& command, std::string& scene, std::vector<std::string>& set) {
  command.add_option("SCENE", scene, "parameter file (.prm or .json)")->required();
  command.add_option("--set", set, "override a parameter: --set 'Section/Key=value', repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "0 = all cores; results do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
}

void add_output(CLI::App& command, std::string& output, const char* fallback) {
  command.add_option("--output", output, std::string("folder [") + fallback + "]")
      ->type_name("DIR");
}

int say(const std::string& message, int code) {
  if (trackbed::fem::rank() > 0) return code;  // rank 0 says it
  std::fprintf(stderr, "trackbed: %s\n", message.c_str());
  return code;
}

/// CLI11's messages name the argument; an unknown command also gets the nearest known one.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error, int argc,
                          char** argv) {
  std::vector<std::string> commands;
  for (const auto* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const auto chosen = app.get_subcommands();
  if (chosen.empty() && argc > 1 && argv[1][0] != '-')
    return std::string("unknown command '") + argv[1] + "'; nearest: '" +
           trackbed::dem::nearest_name(argv[1], commands) + "' (trackbed --help lists all)";
  const std::string name = chosen.empty() ? "" : " " + chosen.front()->get_name();
  std::string text = error.what();
  for (auto& c : text)
    if (c == '\n') c = ' ';
  return text + " (see trackbed" + name + " --help)";
}

/// mpirun tells each rank how many there are; without it MPI starts with the first structure.
void join_ranks() {
  const char* ranks = ::getenv("OMPI_COMM_WORLD_SIZE");
  if (ranks && std::atoi(ranks) > 1) trackbed::fem::start_session();
}

int run_program(int argc, char** argv) {
  CLI::App app{
      "Trackbed computes how a railway ballast bed settles: angular grains under a sleeper,\n"
      "over a subgrade, both rigid or elastic.\n"
      "A first run:  trackbed run apps/scenes/ballast_box.prm",
      "trackbed"};
  app.set_version_flag("--version", "trackbed " TRACKBED_VERSION);
  app.require_subcommand(1);
  std::function<int()> chosen;

  RunOptions run;
  auto* command = app.add_subcommand("run", "pack, load, and write results");
  add_scene(*command, run.scene, run.set);
  add_output(*command, run.output, "results/<scene>");
  add_threads(*command, run.threads);
  command->add_flag("--resume", run.resume, "go on from the folder's checkpoint");
  command->add_flag("--overwrite", run.overwrite, "replace the run that the folder holds");
  command->callback([&] { chosen = [&] { return run_command(run); }; });

  CheckOptions check;
  command = app.add_subcommand("check", "check a scene and print its plan; run nothing");
  add_scene(*command, check.scene, check.set);
  add_threads(*command, check.threads);
  command->callback([&] { chosen = [&] { return check_command(check); }; });

  ParametersOptions parameters;
  command = app.add_subcommand("parameters", "every parameter: default, unit, range, meaning");
  command->add_option("--format", parameters.format, "prm, json or markdown [prm]")
      ->check(CLI::IsMember({"prm", "json", "markdown"}))
      ->type_name("NAME");
  command->callback([&] { chosen = [&] { return parameters_command(parameters); }; });

  SieveOptions sieve;
  command =
      app.add_subcommand("sieve", "sizes of solids and clumps as CSV, in the unit of the files");
  command
      ->add_option("GRAINS", sieve.grains,
                   "OFF, OBJ or STL files of one or more solids; CSV files of a clump, x,y,z,r")
      ->required();
  command
      ->add_option("--dilation", sieve.dilation,
                   "radius of the ball that rounds every solid, in the unit of the files [0]")
      ->check(CLI::NonNegativeNumber)
      ->type_name("R");
  command->add_flag("--hull", sieve.hull, "take the convex hull of solids that are not convex");
  command->add_option("--method", sieve.method, "a sieve method's name, or all [exact]")
      ->type_name("NAME");
  command->add_option("--unit", sieve.unit, "of the files' coordinates: mm, cm or m [mm]")
      ->check(CLI::IsMember({"mm", "cm", "m"}))
      ->type_name("UNIT");
  command->add_option("--curve", sieve.curve, "compare the sample with this curve, by mass")
      ->type_name("NAME");
  command->callback([&] { chosen = [&] { return sieve_command(sieve); }; });

  PackOptions pack;
  command = app.add_subcommand("pack", "grains and packing only");
  add_scene(*command, pack.scene, pack.set);
  command
      ->add_option(
          "--export", pack.formats,
          "write DIR/packing.FORMAT too: off, vtu, csv (Packing/Start from reads off, csv)")
      ->delimiter(',')
      ->check(CLI::IsMember({"off", "vtu", "csv"}))
      ->type_name("FORMATS");
  add_output(*command, pack.output, "results/<scene>");
  add_threads(*command, pack.threads);
  command->add_flag("--overwrite", pack.overwrite, "replace the run that the folder holds");
  command->callback([&] { chosen = [&] { return pack_command(pack); }; });

  CompareOptions compare;
  command = app.add_subcommand("compare", "one packing under rigid and elastic structures");
  add_scene(*command, compare.scene, compare.set);
  add_output(*command, compare.output, "results/<scene>_compare");
  add_threads(*command, compare.threads);
  command->add_option("--packings", compare.packings, "packings with different seeds [1]")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  command->add_flag("--resume", compare.resume, "keep the runs that are finished");
  command->add_flag("--overwrite", compare.overwrite, "replace what the folder holds");
  command->callback([&] { chosen = [&] { return compare_command(compare); }; });

  CostOptions cost;
  command = app.add_subcommand("cost", "accuracy against time: the ladder of every knob");
  add_scene(*command, cost.scene, cost.set);
  add_output(*command, cost.output, "results/<scene>_cost");
  command
      ->add_option(
          "--knobs", cost.knobs,
          "names of knobs, or of effects after --effects, comma-separated [all that matter]")
      ->delimiter(',')
      ->type_name("A,B");
  command->add_option("--pairs", cost.pairs, "every combination of two knobs' rungs")
      ->delimiter(',')
      ->type_name("A:B");
  command->add_option("--tolerance", cost.tolerances, "recommend the cheapest scene within it")
      ->delimiter(',')
      ->type_name("QUANTITY=5%");
  command->add_flag("--effects", cost.effects,
                    "instead of knobs: what each effect costs and changes");
  command->add_option("--seeds", cost.seeds, "packings, each of another seed [3]")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  command->add_option("--threads", cost.threads, "runs at once, one thread each; 0 = all cores")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  command->add_flag("--dry-run", cost.dry_run, "list runs and expected times, run nothing");
  command->add_flag("--resume", cost.resume, "keep the runs that are finished");
  command->add_flag("--overwrite", cost.overwrite, "replace what the folder holds");
  command->callback([&] { chosen = [&] { return cost_command(cost); }; });

  ReportOptions report;
  command = app.add_subcommand("report", "plots and one self-contained HTML page of a run");
  command->add_option("DIR", report.folder, "folder of a run")->required();
  command->callback([&] { chosen = [&] { return report_command(report); }; });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return say(usage_message(app, error, argc, argv), wrong_input);
  }
  // Only a run has work for more than one rank.
  if (trackbed::fem::rank() > 0 && !app.got_subcommand("run")) return 0;
  return chosen();
}

}  // namespace

int main(int argc, char** argv) {
  trackbed::prepare_process(argv);
  join_ranks();
  try {
    return run_program(argc, argv);
  } catch (const trackbed::InputError& error) {
    return say(error.what(), wrong_input);
  } catch (const std::bad_alloc&) {
    return say("out of memory; fewer grains or a coarser mesh need less", failed);
  } catch (const std::exception& error) {
    return say(error.what(), failed);
  }
}
