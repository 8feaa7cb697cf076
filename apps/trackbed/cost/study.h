// What a study of costs runs: the scene itself, a repeat that differs in the last bit, each knob's
// ladder around the scene, grids of two knobs; all over several packing seeds.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/trackbed/cost/jobs.h"
#include "apps/trackbed/cost/knobs.h"

namespace trackbed::apps {

/// One setting of the scene; rows of runs.csv, one a seed.
struct Variant {
  std::string knob;   ///< "own", "repeat", "recommended", a knob's name, or two with a colon
  std::string value;  ///< of the knob; of two with a semicolon
  int rung = 0;       ///< from cheap to exact
  double h = 0;       ///< Rung::h
  bool own = false;   ///< the scene's own setting
  std::vector<std::string> set;
  std::string left_out;   ///< why the scene refuses it; else empty
  std::vector<int> jobs;  ///< into Study::jobs, one a seed
};

struct Study {
  std::string scene, folder;     ///< parameter file; results
  std::vector<std::string> set;  ///< --set of the command
  std::uint64_t first_seed = 1;
  int seeds = 3;
  std::vector<Knob> knobs;
  std::vector<Variant> variants;
  std::vector<Job> jobs;
};

/// The study's variants without jobs. `pairs`: "a:b". Empty `knobs` = all that matter in the scene.
/// `effects`: those instead of knobs, `knobs` then names effects. Throws InputError: unknown knob,
/// a knob that changes nothing in this scene, a pair of one knob.
Study make_study(const std::string& scene, const std::vector<std::string>& set,
                 const std::vector<std::string>& knobs, const std::vector<std::string>& pairs,
                 bool effects, int seeds, const std::string& folder);

/// Gives a variant its jobs with their expected times; equal scenes share a job, equal packings
/// one packing. A variant that the scene's checks refuse is marked as left out.
void add_jobs(Study&, Variant&);

/// runs.csv and knobs.csv for the plots.
void write_study(const Study&);

}  // namespace trackbed::apps
