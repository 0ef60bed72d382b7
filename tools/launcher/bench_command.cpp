#include "tools/launcher/bench_command.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <list>
#include <nlohmann/json.hpp>

#include "common/bus/child.hpp"
#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "tools/launcher/bus_lock.hpp"
#include "tools/launcher/folder_lock.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

constexpr double kWatchPeriodS = 0.05;
constexpr double kDriveEndS = 12.0;  // for the services of a drive
constexpr int kDriveRefused = 2;     // exit status of a drive that never began

struct Suite {
  std::string name;
  std::string seeds;  // unless others are given
  std::string level;  // unless another is given; empty: the scenario's, and one folder and table for all levels
  std::vector<std::string> scenarios;
};

const std::vector<Suite>& suites() {
  static const std::vector<Suite> kSuites = {
      {"seed", "1..10", "", {"seed_traverse_1", "seed_traverse_2"}},
      {"default", "201..240", "efficient", {"default"}},
  };
  return kSuites;
}

const Suite& find_suite(const std::string& name) {
  for (const Suite& suite : suites())
    if (suite.name == name) return suite;
  throw ConfigError("bench: no suite '" + name +
                    "'; known suites: default, seed, full, cost, perception, slam, correction, large_map, speed, "
                    "budget, micro, faults, restarts, page, data, wild, fuzz");
}

struct Job {
  std::string scenario;
  std::int64_t seed;
};

// One bench: its suite, what it runs, and where.
struct Bench {
  const BenchArguments& arguments;
  const Suite& suite;
  std::vector<std::int64_t> seeds;
  std::string commit;
  std::string level;                  // empty: the scenario's
  std::vector<std::string> settings;  // options of each drive, from --level and --set
  std::string suite_dir;
  std::string level_dir;  // equal, unless the suite has a folder per level

  std::string run_dir(const Job& job) const { return level_dir + "/" + job.scenario + "-" + std::to_string(job.seed); }
  std::string log(const Job& job) const { return run_dir(job) + ".log"; }
  std::string rows_file() const { return level_dir + "/rows.jsonl"; }
};

Bench make_bench(const BenchArguments& arguments) {
  const RunArguments& run = arguments.run;
  const Suite& suite = find_suite(arguments.suite);
  Bench bench{arguments, suite, parse_seeds(arguments.seeds.empty() ? suite.seeds : arguments.seeds),
              commit_of(run.source_dir), run.level.empty() ? suite.level : run.level};
  bench.suite_dir = run.source_dir + "/logs/bench/" + suite.name;
  bench.level_dir = suite.level.empty() ? bench.suite_dir : bench.suite_dir + "/" + bench.level;
  if (!bench.level.empty()) bench.settings = {"--level", bench.level};
  for (const std::string& setting : run.set) bench.settings.insert(bench.settings.end(), {"--set", setting});
  return bench;
}

// Empty if it is missing or no text.
std::string text_of(const nlohmann::json& row, const char* key) {
  const auto it = row.find(key);
  return it != row.end() && it->is_string() ? it->get<std::string>() : "";
}

// Rows of drives of one commit with one level and settings: one JSON object per line, appended after each run, so that
// a bench can be resumed. Drives that died are repeated then.
class Rows {
 public:
  explicit Rows(const Bench& bench) : file_(bench.rows_file()), commit_(bench.commit) {
    for (const std::string& word : bench.settings) settings_ += (settings_.empty() ? "" : " ") + word;
    if (bench.arguments.resume) rows_ = finished_rows();
  }

  const nlohmann::json* find(const Job& job) const {
    for (const nlohmann::json& row : rows_)
      if (row.value("scenario", "") == job.scenario && row.value("seed", std::int64_t{-1}) == job.seed) return &row;
    return nullptr;
  }

  // The first one replaces the rows of an earlier bench.
  void add(nlohmann::json row) {
    row["commit"] = commit_;
    row["settings"] = settings_;
    rows_.push_back(std::move(row));
    const std::string file = begun_ ? file_ : file_ + ".new";
    std::ofstream out(file, begun_ ? std::ios::app : std::ios::trunc);
    for (size_t i = begun_ ? rows_.size() - 1 : 0; i < rows_.size(); ++i) out << rows_[i].dump() << "\n";
    out.close();
    if (!out) throw ConfigError(file + ": cannot be written; is the disk full?");
    if (!begun_) fs::rename(file, file_);
    begun_ = true;
  }

 private:
  std::vector<nlohmann::json> finished_rows() const {
    std::vector<nlohmann::json> rows;
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      const auto row = nlohmann::json::parse(line, nullptr, false);
      if (!row.is_object()) continue;
      require_same("of commit", text_of(row, "commit"), commit_);
      require_same("with", text_of(row, "settings"), settings_);
      if (text_of(row, "outcome") != "died") rows.push_back(row);
    }
    return rows;
  }

  void require_same(const char* what, const std::string& there, const std::string& here) const {
    if (there != here)
      throw ConfigError(file_ + ": its drives are " + what + " '" + there + "', these " + what + " '" + here +
                        "'; begin again without --resume");
  }

  std::string file_;
  std::string commit_;
  std::string settings_;
  std::vector<nlohmann::json> rows_;
  bool begun_ = false;
};

std::vector<std::string> drive_command(const Bench& bench, const Job& job, const BusSlot& bus) {
  const RunArguments& run = bench.arguments.run;
  const std::string scenario = run.source_dir + "/config/scenarios/" + job.scenario + ".yaml";
  std::vector<std::string> command = {run.bin_dir + "/rover_launcher", "run", scenario, "--seed",
                                      std::to_string(job.seed)};
  command.insert(command.end(), bench.settings.begin(), bench.settings.end());
  command.insert(command.end(), {"--headless", "--record", "reduced", "--out", bench.run_dir(job), "--bus", bus.url()});
  return command;
}

// A drive that runs.
struct Drive {
  Drive(const Bench& bench, const Job& what) : job(what), child(drive_command(bench, job, bus), bench.log(job)) {}
  Job job;
  BusSlot bus;
  Child child;
};

// A drive that left no metrics is a row too.
nlohmann::json row_of(const Bench& bench, const Job& job, int exit_status) {
  std::ifstream in(bench.run_dir(job) + "/metrics.json");
  nlohmann::json row = nlohmann::json::parse(in, nullptr, false);
  if (!row.is_object()) row = {{"outcome", "died"}, {"level", bench.level}};
  row["scenario"] = job.scenario;
  row["seed"] = job.seed;
  row["exit_status"] = exit_status;
  row["command"] = bench.arguments.command;
  return row;
}

// Throws ConfigError if the drive was refused, or is of a program that somebody built meanwhile.
void finish(const Bench& bench, const Job& job, int exit_status, Rows& rows) {
  const std::string name = job.scenario + " seed " + std::to_string(job.seed) + ": ";
  // A drive that never began leaves no folder.
  if (exit_status == kDriveRefused && !fs::exists(bench.run_dir(job))) throw ConfigError(last_line(bench.log(job)));
  const nlohmann::json row = row_of(bench, job, exit_status);
  const std::string commit = text_of(row, "commit");
  if (!commit.empty() && commit != bench.commit)
    throw ConfigError(name + "its drive is of commit " + commit + ", the bench of " + bench.commit);
  const std::string outcome = text_of(row, "outcome");
  std::printf("%s%s%s\n", name.c_str(), outcome.c_str(), outcome == "died" ? ("; see " + bench.log(job)).c_str() : "");
  std::fflush(stdout);
  if (outcome != "stopped") rows.add(row);  // somebody ended it by hand
}

// Runs the jobs in order, at most `jobs` in parallel. False if the bench was interrupted.
bool run_jobs(const Bench& bench, const std::vector<Job>& jobs, Rows& rows) {
  std::list<Drive> running;
  for (size_t next = 0; keep_running() && (next < jobs.size() || !running.empty()); sleep_s(kWatchPeriodS)) {
    for (; next < jobs.size() && std::ssize(running) < bench.arguments.jobs; ++next) {
      fs::remove_all(bench.run_dir(jobs[next]));
      fs::remove(bench.log(jobs[next]));
      running.emplace_back(bench, jobs[next]);
    }
    for (auto drive = running.begin(); keep_running() && drive != running.end();) {
      const auto this_one = drive++;
      if (this_one->child.running()) continue;
      finish(bench, this_one->job, this_one->child.status(), rows);
      running.erase(this_one);
    }
  }
  for (Drive& drive : running) drive.child.end(kDriveEndS);
  return keep_running();
}

// The table has a section for each level that was run.
int write_table(const Bench& bench) {
  const RunArguments& run = bench.arguments.run;
  std::vector<std::string> command = {run.bin_dir + "/rover_bench_table",
                                      "--suite",
                                      bench.suite.name,
                                      "--out",
                                      run.source_dir + "/test/results/" + bench.suite.name + ".md",
                                      "--command",
                                      bench.arguments.command,
                                      "--rows"};
  if (bench.suite.level.empty()) command.push_back(bench.rows_file());
  for (const char* level : {"efficient", "auto", "full"})
    if (const std::string rows = bench.suite_dir + "/" + level + "/rows.jsonl"; fs::exists(rows))
      command.push_back(rows);
  return run_program(command) == 0 ? 0 : 1;
}

}  // namespace

int bench(const BenchArguments& arguments) {
  if (arguments.run.perception != "rendered")
    throw ConfigError("bench " + arguments.suite +
                      ": its tables are of rendered drives; --perception is an axis of ./rover campaign");
  const Bench bench = make_bench(arguments);
  catch_interrupts();
  const FolderLock lock(bench.suite_dir, "another bench of this suite runs; wait for its end");
  fs::create_directories(bench.level_dir);
  Rows rows(bench);
  std::vector<Job> todo;
  for (const std::string& scenario : bench.suite.scenarios)
    for (const std::int64_t seed : bench.seeds)
      if (rows.find({scenario, seed}) == nullptr) todo.push_back({scenario, seed});
  if (run_jobs(bench, todo, rows)) return write_table(bench);
  std::fprintf(stderr, "%s: stopped; continue with --resume\n", bench.rows_file().c_str());
  return 1;
}

}  // namespace rover
