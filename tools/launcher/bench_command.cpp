#include "tools/launcher/bench_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "tools/launcher/run_command.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

constexpr int kFirstBenchPort = 17'700;

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
  std::string suite_dir;
  std::string level_dir;  // equal, unless the suite has a folder per level

  std::string run_dir(const Job& job) const { return level_dir + "/" + job.scenario + "-" + std::to_string(job.seed); }
};

Bench make_bench(const BenchArguments& arguments) {
  const Suite& suite = find_suite(arguments.suite);
  Bench bench{arguments, suite, parse_seeds(arguments.seeds.empty() ? suite.seeds : arguments.seeds),
              arguments.run.source_dir + "/logs/bench/" + suite.name, ""};
  const std::string level = arguments.run.level.empty() ? suite.level : arguments.run.level;
  bench.level_dir = suite.level.empty() ? bench.suite_dir : bench.suite_dir + "/" + level;
  return bench;
}

// Rows of one suite and commit: one JSON object per line, appended after each run, so that a bench can be resumed.
// Drives that died are repeated then.
class Rows {
 public:
  Rows(const std::string& file, std::string commit, bool resume) : file_(file), commit_(std::move(commit)) {
    fs::create_directories(fs::path(file).parent_path());
    if (resume) rows_ = finished_rows();
    std::ofstream out(file_);
    for (const nlohmann::json& row : rows_) out << row.dump() << "\n";
  }

  const nlohmann::json* find(const Job& job) const {
    for (const nlohmann::json& row : rows_)
      if (row.value("scenario", "") == job.scenario && row.value("seed", std::int64_t{-1}) == job.seed) return &row;
    return nullptr;
  }

  void add(nlohmann::json row) {
    row["commit"] = commit_;
    std::ofstream(file_, std::ios::app) << row.dump() << "\n";
    rows_.push_back(std::move(row));
  }

  const std::string& file() const { return file_; }

 private:
  std::vector<nlohmann::json> finished_rows() const {
    std::vector<nlohmann::json> rows;
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      const auto row = nlohmann::json::parse(line, nullptr, false);
      if (!row.is_object() || row.value("commit", "") != commit_) continue;
      const std::string outcome = row.value("outcome", "");
      if (outcome != "died" && outcome != "stopped") rows.push_back(row);  // stopped: the bench was interrupted
    }
    return rows;
  }

  std::string file_;
  std::string commit_;
  std::vector<nlohmann::json> rows_;
};

RunArguments run_arguments(const Bench& bench, const Job& job, int slot) {
  RunArguments run = bench.arguments.run;
  run.scenario = run.source_dir + "/config/scenarios/" + job.scenario + ".yaml";
  run.seed = job.seed;
  if (run.level.empty()) run.level = bench.suite.level;
  run.out = bench.run_dir(job);
  run.bus = "udpm://239.255.76.67:" + std::to_string(kFirstBenchPort + slot) + "?ttl=0&recv_buf_size=4194304";
  run.record = "reduced";
  run.quiet = true;
  run.headless = true;
  return run;
}

// A drive that left no metrics is a row too.
nlohmann::json row_of(const Bench& bench, const Job& job, int exit_status) {
  std::ifstream in(bench.run_dir(job) + "/metrics.json");
  nlohmann::json row = nlohmann::json::parse(in, nullptr, false);
  if (!row.is_object()) row = {{"outcome", "died"}, {"level", run_arguments(bench, job, 0).level}};
  row["scenario"] = job.scenario;
  row["seed"] = job.seed;
  row["exit_status"] = exit_status;
  row["command"] = bench.arguments.command;
  return row;
}

pid_t start(const Bench& bench, const Job& job, int slot) {
  fs::remove_all(bench.run_dir(job));
  std::fflush(stdout);
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("bench: no further process can be started");
  if (pid == 0) _exit(run(run_arguments(bench, job, slot)).exit_status);
  return pid;
}

void finish(const Bench& bench, const Job& job, int wait_status, Rows& rows) {
  const int exit_status = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 1;
  const nlohmann::json row = row_of(bench, job, exit_status);
  const std::string outcome = row.value("outcome", "unknown");
  std::printf("%s seed %lld: %s\n", job.scenario.c_str(), static_cast<long long>(job.seed),
              outcome == "died" ? ("died; see " + bench.run_dir(job)).c_str() : outcome.c_str());
  std::fflush(stdout);
  rows.add(row);
}

// Runs the jobs in order in child processes, at most `jobs` in parallel.
void run_jobs(const Bench& bench, const std::vector<Job>& jobs, Rows& rows) {
  std::map<pid_t, std::pair<Job, int>> running;  // job and slot
  std::vector<int> free_slots;
  for (int slot = bench.arguments.jobs; slot > 0; --slot) free_slots.push_back(slot);
  size_t next = 0;
  while (next < jobs.size() || !running.empty()) {
    while (next < jobs.size() && !free_slots.empty()) {
      const int slot = free_slots.back();
      free_slots.pop_back();
      running[start(bench, jobs[next], slot)] = {jobs[next], slot};
      ++next;
    }
    int status = 0;
    const auto it = running.find(wait(&status));
    if (it == running.end()) continue;
    const auto [job, slot] = it->second;
    running.erase(it);
    free_slots.push_back(slot);
    finish(bench, job, status, rows);
  }
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
  if (bench.suite.level.empty()) command.push_back(bench.level_dir + "/rows.jsonl");
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
  Rows rows(bench.level_dir + "/rows.jsonl", commit_of(arguments.run.source_dir), arguments.resume);
  std::vector<Job> todo;
  for (const std::string& scenario : bench.suite.scenarios)
    for (const std::int64_t seed : bench.seeds)
      if (rows.find({scenario, seed}) == nullptr) todo.push_back({scenario, seed});
  run_jobs(bench, todo, rows);
  return write_table(bench);
}

}  // namespace rover
