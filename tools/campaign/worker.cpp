#include "tools/campaign/worker.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/bus/child.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "tools/campaign/folder.hpp"
#include "tools/campaign/job.hpp"
#include "tools/campaign/session.hpp"
#include "tools/launcher/bus_lock.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kDrivePollS = 0.05;
constexpr double kDriveEndS = 12.0;                 // for the services of a drive
constexpr std::uintmax_t kMaxKeptLog = 20'000'000;  // a larger log is repeated by one command
constexpr std::uintmax_t kMaxKeptOutput = 100'000;
constexpr double kSpaceCheckS = 5.0;

std::vector<std::string> drive_command(const CampaignInfo& info, const WorkerArguments& arguments, const Job& job,
                                       const std::string& run_dir, const BusSlot& bus) {
  std::vector<std::string> command = {info.drive_program};
  const std::vector<std::string> drive = drive_arguments(arguments.dir, job);
  command.insert(command.end(), drive.begin(), drive.end());
  command.insert(command.end(), {"--headless", "--record", "reduced", "--out", run_dir, "--bus", bus.url()});
  // Disparities and clouds around events are most of such a log; the drive can be repeated with them.
  if (!is_rendered(job))
    command.insert(command.end(), {"--set", "recorder.images_before_s=0", "--set", "recorder.images_after_s=0", "--set",
                                   "recorder.image_interval=1000000"});
  return command;
}

bool has_space(const WorkerArguments& arguments) {
  return free_bytes(arguments.dir) >= arguments.min_free_bytes;
}

// Nothing if the drive was interrupted; else its status.
std::optional<int> drive(const std::vector<std::string>& command, const std::string& log,
                         const WorkerArguments& arguments) {
  Child child(command, log);
  double since_check_s = 0.0;
  while (child.running()) {
    sleep_s(kDrivePollS);
    since_check_s += kDrivePollS;
    if (since_check_s > kSpaceCheckS) {
      since_check_s = 0.0;
      if (!has_space(arguments) || !Session(arguments.work).is_open()) return std::nullopt;
    }
    if (!keep_running()) {
      child.end(kDriveEndS);
      return std::nullopt;
    }
  }
  return child.status();
}

std::optional<Json> read_metrics(const std::string& run_dir) {
  std::ifstream in(run_dir + "/metrics.json");
  Json metrics = Json::parse(in, nullptr, false);
  if (!metrics.is_object() || !metrics.contains("outcome") || !metrics["outcome"].is_string()) return std::nullopt;
  // Somebody ended this drive by hand.
  std::ifstream facts(run_dir + "/run.json");
  const Json run = Json::parse(facts, nullptr, false);
  if (run.is_object() && run.value("interrupted", false)) return std::nullopt;
  return metrics;
}

bool is_failure(const Row& row) {
  const auto collisions = row.figures.find("collisions");
  return row.outcome != "goal_reached" || (collisions != row.figures.end() && collisions->second > 0.0);
}

void keep_run(const WorkerArguments& arguments, const std::string& run_dir) {
  const fs::path kept = fs::path(arguments.dir) / "runs" / std::to_string(arguments.job);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(run_dir, ignored))
    if (arguments.keep == Keep::kFailures && entry.path().extension() == ".lcm" && entry.file_size() > kMaxKeptLog)
      fs::remove(entry.path(), ignored);
  fs::create_directories(kept.parent_path(), ignored);
  fs::remove_all(kept, ignored);
  fs::rename(run_dir, kept, ignored);
}

void keep_output(const WorkerArguments& arguments, const std::string& log) {
  const fs::path kept = fs::path(arguments.dir) / "logs" / ("job-" + std::to_string(arguments.job) + ".log");
  std::error_code error;
  const std::uintmax_t size = fs::file_size(log, error);
  if (error || size == 0) return;
  fs::create_directories(kept.parent_path(), error);
  std::ifstream in(log);
  in.seekg(static_cast<std::streamoff>(size - std::min(size, kMaxKeptOutput)));
  std::ofstream(kept) << in.rdbuf();
}

// Somebody may have built another commit while the campaign runs.
void require_commit(const Json& metrics, const CampaignInfo& info) {
  const Json commit = metrics.value("commit", Json());
  if (commit.is_string() && commit != info.commit)
    throw ConfigError("its drive is of commit " + commit.get<std::string>() + ", the campaign of " + info.commit);
}

// The row of a drive that has ended; nothing if it died.
bool finish(const WorkerArguments& arguments, const CampaignInfo& info, const Job& job, const std::string& run_dir,
            const std::string& log, int status) {
  const Session session(arguments.work);
  const std::optional<Json> metrics = read_metrics(run_dir);
  if (!metrics) {
    const std::string line = last_line(log);
    session.note_death(arguments.job, status_text(status) + (line.empty() ? "" : ": " + line));
    if (arguments.keep != Keep::kNone) {
      keep_output(arguments, log);
      keep_run(arguments, run_dir);
    }
    return false;
  }
  require_commit(*metrics, info);
  Row row{info.commit, job.cell, job.seed, arguments.attempt, "done", "", {}, {}};
  add_metrics(*metrics, row);
  if (arguments.keep == Keep::kAll || (arguments.keep == Keep::kFailures && is_failure(row)))
    keep_run(arguments, run_dir);
  session.write_row(arguments.job, row);
  return true;
}

}  // namespace

std::uint64_t free_bytes(const std::string& dir) {
  std::error_code error;
  const fs::space_info space = fs::space(dir, error);
  return error ? 0 : space.available;
}

int do_job(const WorkerArguments& arguments) try {
  catch_interrupts();
  const Session session(arguments.work);
  if (!has_space(arguments)) session.close_for_full_disk();
  if (!session.is_open()) return 1;
  const CampaignInfo info = read_info(arguments.dir);
  const Job job = read_job(arguments.dir, arguments.job);
  session.note_start(arguments.job, arguments.attempt);
  const BusSlot bus;
  const std::string run_dir = session.run_dir(arguments.job, arguments.attempt);
  const std::string log = run_dir + ".log";
  const std::optional<int> status = drive(drive_command(info, arguments, job, run_dir, bus), log, arguments);
  // Checked before space is freed: on a full disk a drive may have lost a part of its log, here or in another worker.
  if (!has_space(arguments)) session.close_for_full_disk();
  const bool counts = status && session.is_open() && keep_running();
  const bool has_row = counts && finish(arguments, info, job, run_dir, log, *status);
  std::error_code ignored;
  fs::remove_all(run_dir, ignored);
  fs::remove(log, ignored);
  return has_row ? 0 : 1;
} catch (const std::exception& error) {
  // Cannot write where all others have to write too, or cannot read what they read.
  const std::string reason = "job " + std::to_string(arguments.job) + ": " + error.what();
  std::fprintf(stderr, "%s\n", reason.c_str());
  Session(arguments.work).close_because(reason);
  return 1;
}

}  // namespace rover::campaign
