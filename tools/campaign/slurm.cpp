#include "tools/campaign/slurm.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/bus/child.hpp"
#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "common/core/decimal.hpp"
#include "tools/campaign/job.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kAskPeriod{2};  // each question costs the cluster's controller some time
constexpr size_t kDefaultArray = 1001;         // Slurm's own default of MaxArraySize
constexpr double kCancelS = 60.0;
const char* const kNameFile = "/slurm.name";

// Jobs of one array at most.
size_t max_array_size() {
  std::istringstream lines(output_of({"scontrol", "show", "config"}).value_or(""));
  for (std::string key, equals, value; lines >> key;) {
    if (key != "MaxArraySize" || !(lines >> equals >> value)) continue;
    return static_cast<size_t>(parse_whole_number(value).value_or(kDefaultArray));
  }
  return kDefaultArray;
}

// Task I of an array does the job in line I + 1 of its list.
void write_script(const Batch& batch, const std::string& stem, size_t first, size_t count) {
  std::ofstream list(stem + ".jobs");
  for (size_t i = first; i < first + count; ++i) list << batch.jobs[i] << "\n";
  std::ofstream script(stem + ".sh");
  script << "#!/bin/sh\nexec";
  for (const std::string& word : batch.command) script << " " << shell_word(word);
  script << " \"$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" " << shell_word(stem + ".jobs") << ")\"\n";
  list.close();
  script.close();
  if (!list || !script) throw ConfigError(stem + ".sh: cannot be written; is the disk full?");
}

bool has_jobs_named(const std::string& name) {
  const auto jobs = output_of({"squeue", "--noheader", "--name", name, "--format", "%A"});
  return !jobs || !jobs->empty();  // no answer: suppose that they run
}

void cancel(const std::string& name) {
  output_of({"scancel", "--name", name});
  for (double waited_s = 0.0; has_jobs_named(name) && waited_s < kCancelS; waited_s += 0.5) sleep_s(0.5);
}

}  // namespace

void Slurm::start(const Batch& batch) {
  batch_ = batch;
  next_ = 0;
  name_ = "rover-" + fs::path(batch.work).filename().string();
  std::ofstream(batch.work + kNameFile) << name_ << "\n";
  submit();
}

void Slurm::submit() {
  const size_t count = std::min(max_array_size(), batch_.jobs.size() - next_);
  const std::string stem = batch_.work + "/slurm-" + std::to_string(arrays_);
  write_script(batch_, stem, next_, count);
  std::string tasks = "0-" + std::to_string(count - 1);
  if (batch_.parallel_jobs > 0) tasks += "%" + std::to_string(batch_.parallel_jobs);
  const std::string answer = stem + ".answer";
  std::vector<std::string> command = {"sbatch",  "--parsable", "--no-requeue", "--job-name", name_,
                                      "--array", tasks,        "--output",     batch_.log,   "--open-mode",
                                      "append",  "--chdir",    batch_.work};
  // Older versions of sbatch have no variable for it.
  if (batch_.cores_per_job > 1)
    command.insert(command.end(), {"--cpus-per-task", std::to_string(batch_.cores_per_job)});
  command.push_back(stem + ".sh");
  const bool accepted = run_into(answer, command) == 0;
  // Beyond a limit of the cluster on waiting jobs, try again when some have ended.
  if (!accepted && !has_jobs()) throw ConfigError("sbatch: " + last_line(answer));
  if (!accepted) return;
  next_ += count;
  ++arrays_;
  has_jobs_ = true;
  asked_ = Clock::now();
}

bool Slurm::has_jobs() {
  asked_ = Clock::now();
  return has_jobs_ = has_jobs_named(name_);
}

bool Slurm::running() {
  if (Clock::now() - asked_ < kAskPeriod) return has_jobs_ || next_ < batch_.jobs.size();
  has_jobs();
  // Two arrays at the same time would exceed parallel_jobs.
  if (next_ < batch_.jobs.size() && (batch_.parallel_jobs == 0 || !has_jobs_)) submit();
  return has_jobs_ || next_ < batch_.jobs.size();
}

void Slurm::stop() {
  next_ = batch_.jobs.size();
  if (!name_.empty()) cancel(name_);
  has_jobs_ = false;
}

void Slurm::cancel_left(const std::string& work) {
  if (const std::string name = last_line(work + kNameFile); !name.empty() && has_jobs_named(name)) cancel(name);
}

}  // namespace rover::campaign
