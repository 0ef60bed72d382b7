#include "tools/campaign/campaign.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

#include "common/bus/child.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "tools/campaign/campaign_file.hpp"
#include "tools/campaign/engine.hpp"
#include "tools/campaign/folder.hpp"
#include "tools/campaign/job.hpp"
#include "tools/campaign/progress_line.hpp"
#include "tools/campaign/session.hpp"
#include "tools/launcher/arguments.hpp"
#include "tools/launcher/folder_lock.hpp"
#include "tools/launcher/needed_programs.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;

constexpr int kAttempts = 2;
constexpr int kRenderedCores = 2;
constexpr double kCollectPeriodS = 0.5;

std::string config_dir(const CampaignArguments& arguments) {
  return arguments.source_dir + "/config";
}

// A drive's recorder starts with no less.
std::uint64_t min_free_bytes(const CampaignArguments& arguments) {
  double min_free_gb = 1.0;
  Config::load(config_dir(arguments) + "/recorder.yaml").read("min_free_start_gb", min_free_gb, {0, 1e6});
  return static_cast<std::uint64_t>(min_free_gb * 1e9);
}

std::string with_gb(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f GB", static_cast<double>(bytes) / 1e9);
  return text;
}

class Campaign {
 public:
  Campaign(const CampaignArguments& arguments, std::string dir, const CampaignInfo& info)
      : arguments_(arguments),
        dir_(std::move(dir)),
        commit_(info.commit),
        min_free_bytes_(min_free_bytes(arguments)),
        jobs_(read_jobs(dir_)),
        engine_(make_engine(arguments.engine)),
        store_(Store::create(dir_)),
        session_(Session::begin(dir_, store_)),
        progress_(store_.size(), static_cast<std::int64_t>(jobs_.size())) {}

  int run() {
    fs::create_directories(dir_ + "/logs");
    bool complete = true;
    for (int attempt = 1; attempt <= kAttempts && complete; ++attempt) complete = run_attempt(attempt);
    complete = complete && report_died();
    if (!complete && reason_.empty()) reason_ = reason_to_stop();
    session_.close();
    progress_.finish(store_.size());
    session_.collect(store_);
    write_rows();
    session_.remove();
    if (!complete) std::fprintf(stderr, "%s: %s; continue with --resume\n", dir_.c_str(), reason_.c_str());
    if (complete) std::printf("%s: complete%s\n", dir_.c_str(), died_text().c_str());
    return complete ? 0 : 1;
  }

 private:
  std::vector<int> missing() const {
    const std::set<Key> present = store_.keys(commit_);
    std::vector<int> numbers;
    for (size_t i = 0; i < jobs_.size(); ++i)
      if (!present.contains({cell_text(jobs_[i].cell), jobs_[i].seed})) numbers.push_back(static_cast<int>(i) + 1);
    return numbers;
  }

  Batch batch(const std::vector<int>& jobs, int attempt) const {
    const char* const keep[] = {"none", "failures", "all"};
    return {jobs,
            {arguments_.bin_dir + "/rover_campaign", "job", "--dir", dir_, "--work", session_.work(), "--attempt",
             std::to_string(attempt), "--keep", keep[static_cast<int>(arguments_.keep)], "--min-free",
             std::to_string(min_free_bytes_)},
            session_.work(),
            dir_ + "/logs/engine.log",
            arguments_.jobs,
            arguments_.sshloginfile,
            std::any_of(jobs_.begin(), jobs_.end(), is_rendered) ? kRenderedCores : 1};
  }

  // False if the campaign cannot go on.
  bool run_attempt(int attempt) {
    const std::vector<int> jobs = missing();
    if (jobs.empty()) return true;
    engine_->start(batch(jobs, attempt));
    try {
      while (engine_->running() && may_go_on()) {
        session_.collect(store_);
        progress_.show(store_.size());
        sleep_s(kCollectPeriodS);
      }
    } catch (...) {
      session_.close();
      engine_->stop();
      throw;
    }
    const bool ended = may_go_on();
    if (!ended) {
      session_.close();  // a worker that the engine has just begun ends by itself
      engine_->stop();
    }
    session_.collect(store_);
    return ended && require_begun(jobs, attempt, true);
  }

  bool may_go_on() {
    if (free_bytes(dir_) < min_free_bytes_) session_.close_for_full_disk();
    return keep_running() && session_.is_open();
  }

  // Jobs that the engine never began have not died.
  bool require_begun(const std::vector<int>& jobs, int attempt, bool any) {
    const auto begun = [&](int job) { return session_.has_started(job, attempt); };
    const auto count = static_cast<size_t>(std::count_if(jobs.begin(), jobs.end(), begun));
    if (count == jobs.size() || (any && count > 0)) return true;
    reason_ = arguments_.engine + " ended, and did not begin " + std::to_string(jobs.size() - count) + " drives; see " +
              dir_ + "/logs/engine.log";
    return false;
  }

  bool report_died() {
    const std::vector<int> died = missing();
    for (int attempt = 1; attempt <= kAttempts; ++attempt)
      if (!require_begun(died, attempt, false)) return false;
    std::vector<Row> rows;
    for (const int number : died) {
      const Job& job = jobs_[static_cast<size_t>(number) - 1];
      rows.push_back({commit_, job.cell, job.seed, kAttempts, "died", "", {}, {}});
      rows.back().texts["reason"] = session_.reason_of_death(number);
    }
    store_.add(rows);
    return true;
  }

  void write_rows() const {
    const std::string file = dir_ + "/rows.jsonl";
    std::ofstream out(file + ".new");
    store_.each([&](const Row& row) { out << json_line(row) << "\n"; });
    out.close();
    if (!out) throw ConfigError(file + ": cannot be written; is the disk full?");
    fs::rename(file + ".new", file);
  }

  std::string died_text() const {
    const std::int64_t died = store_.died();
    return died == 0 ? "" : ", " + std::to_string(died) + " drives died";
  }

  std::string reason_to_stop() const {
    if (!keep_running()) return "stopped";
    if (session_.found_full_disk()) return "disk full: " + with_gb(min_free_bytes_) + " have to be free";
    if (const std::string reason = session_.reason_to_close(); !reason.empty()) return reason;
    return "a worker could not write; see " + dir_ + "/logs/engine.log";
  }

  const CampaignArguments& arguments_;
  std::string dir_;
  std::string commit_;
  std::uint64_t min_free_bytes_;
  std::vector<Job> jobs_;
  std::unique_ptr<Engine> engine_;
  Store store_;
  Session session_;
  ProgressLine progress_;
  std::string reason_;
};

void require_space(const CampaignArguments& arguments, const std::string& dir) {
  if (free_bytes(dir) >= min_free_bytes(arguments)) return;
  throw ConfigError(dir + ": disk full: " + with_gb(min_free_bytes(arguments)) + " have to be free");
}

}  // namespace

int run_campaign(const CampaignArguments& arguments) {
  const CampaignFile file = load_campaign(arguments.file, config_dir(arguments));
  const std::string dir = arguments.out.empty() ? arguments.source_dir + "/logs/campaigns/" + file.name : arguments.out;
  const CampaignInfo info = {
      file.name, commit_of(arguments.source_dir), arguments.command,
      arguments.drive_program.empty() ? arguments.bin_dir + "/rover_launcher" : arguments.drive_program};
  make_engine(arguments.engine);  // refused before a folder is made
  catch_interrupts();
  const FolderLock lock(dir, "another campaign runs in this folder; wait for its end, or choose another with --out");
  require_space(arguments, dir);
  if (has_campaign(dir)) {
    if (!arguments.resume)
      throw ConfigError(dir + ": has a campaign; continue it with --resume, or choose another folder with --out");
    require_same(dir, arguments.file, info);
  } else {
    make_campaign(dir, arguments.file, file, info);
  }
  return Campaign(arguments, dir, info).run();
}

bool needs_full_level(const CampaignArguments& arguments) {
  std::set<std::array<std::string, 3>> kinds;  // base scenario, level, perception
  for (const Drive& drive : load_campaign(arguments.file, config_dir(arguments)).drives) {
    const auto value = [&](const char* axis) { return drive.cell.contains(axis) ? drive.cell.at(axis) : ""; };
    kinds.insert({drive.scenario, value("level"), value("perception")});
  }
  return std::any_of(kinds.begin(), kinds.end(), [](const auto& kind) {
    RunArguments run;
    run.scenario = kind[0];
    run.level = kind[1];
    if (!kind[2].empty()) run.perception = kind[2];
    return rover::needs_full_level(run);
  });
}

}  // namespace rover::campaign
