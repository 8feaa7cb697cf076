#include "apps/trackbed/cost/jobs.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "apps/trackbed/cost/subprocess.h"
#include "apps/trackbed/csv.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/signals.h"

namespace trackbed::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr auto look_interval = std::chrono::milliseconds(50);
constexpr char marker[] = "job.csv";

struct Running {
  std::size_t job;
  pid_t process;
  Clock::time_point begun;
};

void write_marker(const Job& job, const std::string& folder) {
  const char* status = job.status == JobStatus::done     ? "done"
                       : job.status == JobStatus::failed ? "failed"
                                                         : "stopped";
  write_aside_then_rename(folder + "/" + job.folder + "/" + marker,
                          "inputs,status,processor_s\n" + job.inputs + "," + status + "," +
                              shortest(job.seconds) + "\n");
}

/// The last line a failed run wrote, without the program's name.
std::string last_line(const std::string& log) {
  std::ifstream in(log);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  const std::string name = "trackbed: ";
  return last.compare(0, name.size(), name) == 0 ? last.substr(name.size()) : last;
}

std::vector<std::string> arguments_of(const Job& job, const JobOptions& options) {
  const std::string path = options.folder + "/" + job.folder;
  std::vector<std::string> words{
      job.packing < 0 ? "pack" : "run", options.scene, "--output", path, "--threads", "1"};
  // A packing starts again: it is kept only when it is whole.
  const bool goes_on = job.packing >= 0 && fs::exists(path + "/checkpoint.h5") &&
                       fs::exists(path + "/" + marker) && job.seconds > 0;
  words.push_back(goes_on ? "--resume" : "--overwrite");
  for (const auto& change : job.set) words.insert(words.end(), {"--set", change});
  return words;
}

Running begin(Job& job, std::size_t index, const JobOptions& options) {
  const std::string path = options.folder + "/" + job.folder;
  fs::create_directories(path);
  return {index, start_self(arguments_of(job, options), path + "/log.txt"), Clock::now()};
}

void end(Job& job, const Ended& how, const JobOptions& options) {
  job.seconds += how.cpu_seconds;
  if (how.code == 0) {
    job.status = JobStatus::done;
  } else if (!stop_requested()) {
    job.status = JobStatus::failed;
    job.message = last_line(options.folder + "/" + job.folder + "/log.txt");
  }
  write_marker(job, options.folder);
}

bool over(const Job& job) { return job.status != JobStatus::waiting; }

/// The first job that waits for nothing; jobs.size() if there is none now.
std::size_t next_ready(std::vector<Job>& jobs, const std::vector<Running>& running) {
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    Job& job = jobs[k];
    const bool under_way =
        std::any_of(running.begin(), running.end(), [k](const Running& r) { return r.job == k; });
    if (over(job) || under_way) continue;
    if (job.packing < 0 || jobs[job.packing].status == JobStatus::done) return k;
    if (jobs[job.packing].status == JobStatus::failed) {
      job.status = JobStatus::failed;
      job.message = "its packing failed: " + jobs[job.packing].message;
    }
  }
  return jobs.size();
}

/// Expected seconds of what is done, those under way by the clock.
double work_done(const std::vector<Job>& jobs, const std::vector<Running>& running) {
  double sum = 0;
  for (const Job& job : jobs)
    if (over(job)) sum += job.expected;
  for (const Running& r : running) {
    const std::chrono::duration<double> since = Clock::now() - r.begun;
    sum += std::min(0.95 * jobs[r.job].expected, since.count());
  }
  return sum;
}

}  // namespace

void recognise_finished(std::vector<Job>& jobs, const std::string& folder) {
  for (Job& job : jobs) {
    const std::string file = folder + "/" + job.folder + "/" + marker;
    if (!fs::exists(file)) continue;
    std::istringstream text(read_text(file));
    std::string header, inputs, status, seconds;
    std::getline(text, header);
    std::getline(text, inputs, ','), std::getline(text, status, ','), std::getline(text, seconds);
    if (inputs != job.inputs || status == "failed") continue;
    job.seconds = std::strtod(seconds.c_str(), nullptr);
    if (status == "done") job.status = JobStatus::done;
  }
}

bool run_jobs(std::vector<Job>& jobs, const JobOptions& options, Progress& progress) {
  double total = 0;
  std::size_t done = std::count_if(jobs.begin(), jobs.end(), over);
  for (const Job& job : jobs) total += job.expected;
  progress.begin_work("runs", work_done(jobs, {}), total);
  std::vector<Running> running;
  bool told = false;
  while (true) {
    while (!stop_requested() && static_cast<int>(running.size()) < options.at_once) {
      const std::size_t next = next_ready(jobs, running);
      if (next == jobs.size()) break;
      running.push_back(begin(jobs[next], next, options));
    }
    if (running.empty()) break;
    if (stop_requested() && !told) {
      for (const Running& r : running) stop(r.process);
      told = true;
    }
    std::this_thread::sleep_for(look_interval);
    for (std::size_t k = 0; k < running.size();) {
      Job& job = jobs[running[k].job];
      const auto how = ended(running[k].process);
      if (!how) {
        ++k;
        continue;
      }
      end(job, *how, options);
      done += over(job);
      if (job.status == JobStatus::failed) progress.note(job.folder + " failed: " + job.message);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(k));
    }
    if (progress.due())
      progress.update(work_done(jobs, running),
                      std::to_string(done) + " of " + std::to_string(jobs.size()) + " runs done");
  }
  progress.finish(work_done(jobs, {}),
                  std::to_string(std::count_if(jobs.begin(), jobs.end(), over)) + " of " +
                      std::to_string(jobs.size()) + " runs done");
  return !stop_requested();
}

}  // namespace trackbed::apps
