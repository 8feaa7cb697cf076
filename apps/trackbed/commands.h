// The subcommands of `trackbed`, one file each. A command returns the exit code; wrong input
// leaves it as InputError (exit 2), a failed run as RunError (exit 1).
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

struct RunOptions {
  std::string scene;             ///< parameter file
  std::string output;            ///< folder; empty = results/<scene>
  std::vector<std::string> set;  ///< "Section/Key=value"
  int threads = 0;               ///< 0 = all cores
  bool resume = false;
  bool overwrite = false;
};

struct CheckOptions {
  std::string scene;
  std::vector<std::string> set;
  int threads = 0;
};

struct PackOptions {
  std::string scene;
  std::vector<std::string> formats;  ///< to export to: off, vtu, csv
  std::string output;                ///< folder; empty = results/<scene>
  std::vector<std::string> set;
  int threads = 0;
  bool overwrite = false;
};

struct CompareOptions {
  std::string scene;
  std::string output;  ///< folder; empty = results/<scene>_compare
  std::vector<std::string> set;
  int threads = 0;
  int packings = 1;
  bool resume = false;
  bool overwrite = false;
};

struct CostOptions {
  std::string scene;
  std::string output;  ///< folder; empty = results/<scene>_cost
  std::vector<std::string> set;
  std::vector<std::string> knobs;       ///< names; empty = all that matter
  std::vector<std::string> pairs;       ///< "a:b": grids of two knobs
  std::vector<std::string> tolerances;  ///< "settlement=5%"
  bool effects = false;                 ///< each effect off and on, instead of knobs
  int seeds = 3;
  int threads = 0;  ///< runs at once, one thread each; 0 = all cores
  bool dry_run = false;
  bool resume = false;
  bool overwrite = false;
};

struct ParametersOptions {
  std::string format = "prm";  ///< prm | json | markdown
};

struct SieveOptions {
  std::vector<std::string> grains;  ///< OFF, OBJ, STL files of solids, CSV files of clumps
  std::string method = "exact";     ///< a name, or "all"
  std::string unit = "mm";          ///< of the files' coordinates: mm, cm or m
  std::string curve;                ///< name of a standard's curve to compare with; empty = none
  double dilation = 0;              ///< radius of a ball around every solid [unit]
  bool hull = false;                ///< solids that are not convex are replaced by their hulls
};

struct ReportOptions {
  std::string folder;  ///< of a run or a comparison
};

int run_command(const RunOptions&);
int check_command(const CheckOptions&);
int pack_command(const PackOptions&);
int compare_command(const CompareOptions&);
int cost_command(const CostOptions&);
int parameters_command(const ParametersOptions&);
int sieve_command(const SieveOptions&);
int report_command(const ReportOptions&);

}  // namespace trackbed::apps
