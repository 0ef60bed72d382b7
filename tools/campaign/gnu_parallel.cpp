#include "tools/campaign/gnu_parallel.hpp"

#include <fstream>

#include "common/bus/config.hpp"

namespace rover::campaign {
namespace {

// Its exit status is the number of failed jobs, at most 101.
constexpr int kMaxFailed = 101;
// A drive ends its services in that time; then its worker is killed.
const char* const kTermination = "TERM,15000,KILL,25";
constexpr double kStopS = 25.0;

std::string write_list(const Batch& batch) {
  const std::string file = batch.work + "/parallel.jobs";
  std::ofstream out(file);
  for (const int job : batch.jobs) out << job << "\n";
  out.close();
  if (!out) throw ConfigError(file + ": cannot be written; is the disk full?");
  return file;
}

}  // namespace

void GnuParallel::start(const Batch& batch) {
  // --plain: not with the options of the user's own profile. A worker that fails does not end the others.
  std::vector<std::string> command = {"parallel", "--plain", "--will-cite", "--quote",   "--ungroup",
                                      "--halt",   "never",   "--termseq",   kTermination};
  if (batch.parallel_jobs > 0) command.insert(command.end(), {"--jobs", std::to_string(batch.parallel_jobs)});
  if (!batch.sshloginfile.empty()) command.insert(command.end(), {"--sshloginfile", batch.sshloginfile});
  command.insert(command.end(), {"--arg-file", write_list(batch)});
  command.insert(command.end(), batch.command.begin(), batch.command.end());
  command.emplace_back("{}");
  log_ = batch.log;
  child_ = std::make_unique<Child>(command, batch.log);
}

bool GnuParallel::running() {
  if (child_ == nullptr) return false;
  if (child_->running()) return true;
  if (child_->status() > kMaxFailed)
    throw ConfigError("GNU parallel: " + status_text(child_->status()) + "; see " + log_);
  return false;
}

void GnuParallel::stop() {
  if (child_ != nullptr) child_->end(kStopS);
}

}  // namespace rover::campaign
