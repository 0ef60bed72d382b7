#include "tools/launcher/bench_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "tools/launcher/run_command.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

// Minimum number of repairs of a valid run. With fewer, too few rocks blocked the path.
const std::map<std::string, int> kMinRepairs = {{"seed_traverse_1", 5}, {"seed_traverse_2", 8}};
// Additional seeds that may replace invalid runs.
constexpr int kSpareSeeds = 10;
constexpr int kFirstBenchPort = 17'700;

struct Job {
  std::string scenario;
  std::int64_t seed;
};

// Rows of one suite and commit: one JSON object per line, appended after each run, so that a bench can be resumed.
class Rows {
 public:
  Rows(const std::string& file, std::string commit, bool resume) : file_(file), commit_(std::move(commit)) {
    fs::create_directories(fs::path(file).parent_path());
    if (!resume) {
      fs::remove(file_);
      return;
    }
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      const auto row = nlohmann::json::parse(line, nullptr, false);
      if (row.is_object() && row.value("commit", "") == commit_) rows_.push_back(row);
    }
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
  std::string file_;
  std::string commit_;
  std::vector<nlohmann::json> rows_;
};

bool counts(const nlohmann::json& row) {
  const auto minimum = kMinRepairs.find(row.value("scenario", ""));
  if (minimum == kMinRepairs.end() || row.value("outcome", "") != "goal_reached") return true;
  return row.contains("replans") && row["replans"].is_number() && row["replans"].get<int>() >= minimum->second;
}

std::string out_dir(const BenchArguments& arguments, const Job& job) {
  return arguments.run.source_dir + "/logs/bench/" + arguments.suite + "/" + job.scenario + "-" +
         std::to_string(job.seed);
}

RunArguments run_arguments(const BenchArguments& arguments, const Job& job, int slot) {
  RunArguments run = arguments.run;
  run.scenario = arguments.run.source_dir + "/config/scenarios/" + job.scenario + ".yaml";
  run.seed = job.seed;
  run.out = out_dir(arguments, job);
  run.bus = "udpm://239.255.76.67:" + std::to_string(kFirstBenchPort + slot) + "?ttl=0&recv_buf_size=4194304";
  run.record = "reduced";
  run.quiet = true;
  run.headless = true;
  return run;
}

nlohmann::json row_of(const Job& job, const std::string& dir, int exit_status) {
  std::ifstream in(dir + "/metrics.json");
  nlohmann::json row = nlohmann::json::parse(in, nullptr, false);
  if (!row.is_object()) row = {{"outcome", "no_metrics"}};
  row["scenario"] = job.scenario;
  row["seed"] = job.seed;
  row["exit_status"] = exit_status;
  return row;
}

// Runs the jobs in order in child processes, at most `jobs` in parallel.
void run_jobs(const BenchArguments& arguments, const std::vector<Job>& jobs, Rows& rows) {
  std::map<pid_t, std::pair<Job, int>> running;  // job and slot
  std::vector<int> free_slots;
  for (int slot = arguments.jobs; slot > 0; --slot) free_slots.push_back(slot);
  size_t next = 0;
  while (next < jobs.size() || !running.empty()) {
    while (next < jobs.size() && !free_slots.empty()) {
      const Job job = jobs[next++];
      const int slot = free_slots.back();
      free_slots.pop_back();
      fs::remove_all(out_dir(arguments, job));
      std::fflush(stdout);
      const pid_t pid = fork();
      if (pid == 0) _exit(run(run_arguments(arguments, job, slot)).exit_status);
      running[pid] = {job, slot};
    }
    int status = 0;
    const pid_t ended = wait(&status);
    const auto it = running.find(ended);
    if (it == running.end()) continue;
    const auto [job, slot] = it->second;
    running.erase(it);
    free_slots.push_back(slot);
    const int exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    const nlohmann::json row = row_of(job, out_dir(arguments, job), exit_status);
    std::printf("%s seed %lld: %s\n", job.scenario.c_str(), static_cast<long long>(job.seed),
                row.value("outcome", "unknown").c_str());
    rows.add(row);
  }
}

}  // namespace

int bench(const BenchArguments& arguments) {
  if (arguments.suite != "seed")
    throw ConfigError("bench: no suite '" + arguments.suite +
                      "'; known suites: seed, full, slam, correction, speed, micro, faults, restarts, page, data");
  Rows rows(arguments.run.source_dir + "/logs/bench/" + arguments.suite + "/rows.jsonl",
            commit_of(arguments.run.source_dir), arguments.resume);
  for (const auto& [scenario, minimum] : kMinRepairs) {
    std::vector<std::int64_t> seeds = arguments.seeds;
    size_t wanted = seeds.size();
    for (int spare = 0; spare <= kSpareSeeds; ++spare) {
      std::vector<Job> todo;
      size_t counted = 0;
      for (const std::int64_t seed : seeds) {
        const nlohmann::json* row = rows.find({scenario, seed});
        if (row == nullptr) todo.push_back({scenario, seed});
        if (row != nullptr && counts(*row)) ++counted;
      }
      if (todo.empty() && counted >= wanted) break;
      if (todo.empty()) {
        seeds.push_back(seeds.back() + 1);
        continue;
      }
      run_jobs(arguments, todo, rows);
    }
  }
  const std::string table = arguments.run.source_dir + "/test/results/" + arguments.suite + ".md";
  return run_program({arguments.run.bin_dir + "/rover_bench_table", "--suite", arguments.suite, "--rows", rows.file(),
                      "--out", table, "--command", arguments.command}) == 0
             ? 0
             : 1;
}

}  // namespace rover
