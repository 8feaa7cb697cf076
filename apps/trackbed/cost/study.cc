#include "apps/trackbed/cost/study.h"

#include <algorithm>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/hash.h"
#include "apps/trackbed/plan.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/simulation/packing_store.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

/// Packings are the study's own, so that each is timed; pictures are not drawn.
std::vector<std::string> of_every_run(const std::string& folder) {
  return {"Packing/Folder=" + folder + "/packings", "Packing/Reuse=true",
          "Output/Snapshot interval=0", "Output/Structure fields=false"};
}

std::string folder_of(const Variant& v, int seed) {
  std::string name = v.knob;
  if (!v.value.empty()) name += "=" + v.value;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '=' && c != '-') c = '_';
  return "runs/" + name + "/seed_" + std::to_string(seed);
}

std::vector<Knob> chosen_knobs(const std::vector<std::string>& names, const Scene& scene,
                               const std::vector<Knob>& all) {
  std::vector<Knob> knobs;
  if (names.empty()) {
    for (const Knob& knob : all)
      if (matters_in(knob, scene)) knobs.push_back(knob);
    return knobs;
  }
  for (const auto& name : names) {
    const Knob knob = knob_by_name(name, all);
    if (!matters_in(knob, scene))
      throw InputError("--knobs " + name + ": changes nothing in this scene; needs " + knob.needs);
    knobs.push_back(knob);
  }
  return knobs;
}

void add_ladder(Study& study, const Knob& knob, const Scene& scene) {
  int index = 0;
  for (const Rung& rung : ladder(knob, scene)) {
    std::vector<std::string> set{knob.path + "=" + rung.value};
    if (!knob.rungs.empty() && rung.value == knob.rungs.back())
      set.insert(set.end(), knob.also.begin(), knob.also.end());
    if (!rung.own) set.insert(set.end(), knob.with.begin(), knob.with.end());
    study.variants.push_back({knob.name, rung.value, index++, rung.h, rung.own, set, {}, {}});
  }
}

void add_pair(Study& study, const std::string& pair, const Scene& scene) {
  const auto colon = pair.find(':');
  if (colon == std::string::npos)
    throw InputError("--pairs '" + pair + "': two knobs with a colon between them are needed");
  const Knob a = knob_by_name(pair.substr(0, colon)), b = knob_by_name(pair.substr(colon + 1));
  if (a.name == b.name) throw InputError("--pairs '" + pair + "': two different knobs are needed");
  int index = 0;
  for (const Rung& x : ladder(a, scene))
    for (const Rung& y : ladder(b, scene))
      study.variants.push_back({pair,
                                x.value + "; " + y.value,
                                index++,
                                0,
                                x.own && y.own,
                                {a.path + "=" + x.value, b.path + "=" + y.value},
                                {},
                                {}});
}

int job_with(const Study& study, const std::string& inputs) {
  const auto found = std::find_if(study.jobs.begin(), study.jobs.end(),
                                  [&](const Job& job) { return job.inputs == inputs; });
  return found == study.jobs.end() ? -1 : static_cast<int>(found - study.jobs.begin());
}

struct Expected {
  double packing = 0, run = 0;
};

Expected expected_seconds(const Scene& scene) {
  Expected sum;
  for (const auto& stage : make_plan(scene, 1).stages)
    (stage.loads ? sum.run : sum.packing) += stage.seconds;
  return sum;
}

int add_job(Study& study, Job job) {
  study.jobs.push_back(std::move(job));
  return static_cast<int>(study.jobs.size()) - 1;
}

}  // namespace

Study make_study(const std::string& file, const std::vector<std::string>& set,
                 const std::vector<std::string>& knobs, const std::vector<std::string>& pairs,
                 bool effects, int seeds, const std::string& folder) {
  const Scene scene = read_scene(file, set);
  if (scene.test.on())
    throw InputError(file + ": Test/Type = " + scene.test.type +
                     ": cost compares what load cycles do; it needs Test/Type = none");
  Study study{file,  folder,
              set,   scene.grains.seed,
              seeds, chosen_knobs(knobs, scene, effects ? effect_knobs(scene) : all_knobs()),
              {},    {}};
  study.variants.push_back({"own", "", 0, 0, true, {}, {}, {}});
  // What differs after a change of about one bit is noise, not accuracy.
  study.variants.push_back({"repeat", "", 0, 0, false, {"Numerics/Mirror noise=1e-15"}, {}, {}});
  for (const Knob& knob : study.knobs) add_ladder(study, knob, scene);
  for (const auto& pair : pairs) add_pair(study, pair, scene);
  return study;
}

void add_jobs(Study& study, Variant& variant) {
  std::vector<std::string> set = study.set;
  for (const auto& list : {of_every_run(study.folder), variant.set})
    set.insert(set.end(), list.begin(), list.end());
  set.emplace_back();  // the seed
  Expected expected;
  for (int k = 0; k < study.seeds; ++k) {
    set.back() = "Grains/Seed=" + std::to_string(study.first_seed + k);
    try {
      const Scene scene = read_scene(study.scene, set);
      const std::string inputs = hash_name(scene.resolved), packing = packing_name(scene);
      int job = job_with(study, inputs);
      if (job < 0) {
        if (k == 0) expected = expected_seconds(scene);
        int base = job_with(study, packing);
        if (base < 0)
          base = add_job(study, {"packs/" + packing, set, packing, -1, expected.packing,
                                 JobStatus::waiting, 0, ""});
        job = add_job(study, {folder_of(variant, k + 1), set, inputs, base, expected.run,
                              JobStatus::waiting, 0, ""});
      }
      variant.jobs.push_back(job);
    } catch (const InputError& error) {
      variant.left_out = error.what();
      variant.jobs.clear();
      return;
    }
  }
}

void write_study(const Study& study) {
  CsvWriter knobs(study.folder + "/knobs.csv", {"knob", "path", "quantity", "order", "meaning"});
  for (const Knob& k : study.knobs)
    knobs.row({k.name, k.path, k.quantity, k.order > 0 ? CsvCell(k.order) : CsvCell(), k.meaning});
  knobs.flush();

  CsvWriter runs(study.folder + "/runs.csv",
                 {"knob", "value", "rung", "h", "own", "seed", "folder", "status",
                  "packing_processor_s", "run_processor_s", "message", "set"});
  for (const Variant& v : study.variants) {
    std::string set;
    for (const auto& change : v.set) set += (set.empty() ? "" : "\n") + change;
    const CsvCell h = v.h > 0 ? CsvCell(v.h) : CsvCell();
    if (!v.left_out.empty())
      runs.row({v.knob, v.value, v.rung, h, v.own, 0, "", "left out", CsvCell(), CsvCell(),
                v.left_out, set});
    for (std::size_t k = 0; k < v.jobs.size(); ++k) {
      const Job& job = study.jobs[v.jobs[k]];
      const char* status = job.status == JobStatus::done     ? "done"
                           : job.status == JobStatus::failed ? "failed"
                                                             : "waiting";
      runs.row({v.knob, v.value, v.rung, h, v.own, k + 1, job.folder, status,
                study.jobs[job.packing].seconds, job.seconds, job.message, set});
    }
  }
  runs.flush();
}

}  // namespace trackbed::apps
