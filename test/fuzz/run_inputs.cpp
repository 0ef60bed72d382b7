#include "run_inputs.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <new>

#include "common/bus/config.hpp"
#include "common/geo/elevation_map.hpp"

namespace rover::fuzz {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kBatch = 250;
constexpr size_t kMostFindings = 20;
constexpr int kFound = 3;  // exit status of a child that reports a finding

// Output files of a child.
struct Progress {
  std::uint64_t number;
  std::uint64_t refused;
  double worst_cpu_s;
  std::uint64_t worst_number;
  double memory_mb;
  char what[200];
};

double cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

[[noreturn]] void found(Progress& progress, const std::string& what) {
  std::strncpy(progress.what, what.c_str(), sizeof progress.what - 1);
  _exit(kFound);
}

// SIGPROF ends a process that computes for too long, SIGALRM one that waits.
void set_alarms(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  const itimerval cpu{{0, 0}, {whole, static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(whole)))}};
  const itimerval wall{{0, 0}, {20 * whole + 20, 0}};
  setitimer(ITIMER_PROF, &cpu, nullptr);
  setitimer(ITIMER_REAL, &wall, nullptr);
}

// A refusal must be one printable line.
void check_refusal(const std::string& line, Progress& progress) {
  if (line.empty() || line.size() > 2000 || line.find('\n') != std::string::npos)
    found(progress, "the refusal is not one line: " + line);
  ++progress.refused;
}

void run_one(const Parser& parser, const Campaign& campaign, Scratch& scratch, Progress& progress) {
  const Input input = mutated(parser.corpus, parser.words, campaign.seed, progress.number);
  set_alarms(campaign.max_cpu_s);
  const double before = cpu_s();
  try {
    parser.run(input, scratch);
  } catch (const ConfigError& refusal) {
    check_refusal(refusal.what(), progress);
  } catch (const DtmError& refusal) {
    check_refusal(refusal.what(), progress);
  } catch (const std::exception& error) {
    found(progress, std::string("an exception that is no refusal: ") + error.what());
  }
  const double took = cpu_s() - before;
  if (took > progress.worst_cpu_s) {
    progress.worst_cpu_s = took;
    progress.worst_number = progress.number;
  }
  progress.memory_mb = std::max(progress.memory_mb, memory_mb());
  if (progress.memory_mb > campaign.max_memory_mb)
    found(progress, "takes " + std::to_string(static_cast<int>(progress.memory_mb)) + " MB");
  if (const std::string name = scratch.changed(); !name.empty()) found(progress, "an input is written over: " + name);
  scratch.remove_results();
}

[[noreturn]] void run_batch(const Parser& parser, const Campaign& campaign, std::uint64_t end, const fs::path& dir,
                            Progress& progress) {
  const int said = open((dir / "said").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  dup2(said, STDOUT_FILENO);
  dup2(said, STDERR_FILENO);
#ifndef __SANITIZE_ADDRESS__
  const rlimit limit{rlim_t{4} << 30, rlim_t{4} << 30};
  setrlimit(RLIMIT_AS, &limit);
#endif
  Scratch scratch(dir / "files");
  for (; progress.number < end; ++progress.number) run_one(parser, campaign, scratch, progress);
  _exit(0);
}

std::string ending(int status, const Progress& progress) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kFound) return progress.what;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) return "computes for too long";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) return "waits for too long";
  if (WIFSIGNALED(status)) return std::string("ends by signal: ") + strsignal(WTERMSIG(status));
  return "ends with status " + std::to_string(WEXITSTATUS(status));
}

// Stores the input and the output of the process (sanitizer report).
Finding keep(const Parser& parser, const Campaign& campaign, std::uint64_t number, const std::string& what,
             const fs::path& said) {
  fs::create_directories(campaign.findings_dir);
  const Input input = mutated(parser.corpus, parser.words, campaign.seed, number);
  const std::string name = parser.name + "-" + std::to_string(campaign.seed) + "-" + std::to_string(number);
  const fs::path file = fs::path(campaign.findings_dir) / (name + "-" + fs::path(input.name).filename().string());
  std::ofstream(file, std::ios::binary) << input.bytes;
  fs::copy_file(said, file.string() + ".said", fs::copy_options::overwrite_existing);
  return {number, what, file.string()};
}

class SharedProgress {
 public:
  SharedProgress()
      : memory_(mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (memory_ == MAP_FAILED) throw std::bad_alloc();
  }
  ~SharedProgress() { munmap(memory_, sizeof(Progress)); }
  SharedProgress(const SharedProgress&) = delete;
  SharedProgress& operator=(const SharedProgress&) = delete;
  Progress& operator*() const { return *static_cast<Progress*>(memory_); }

 private:
  void* memory_;
};

void add(const Progress& progress, std::uint64_t begin, Outcome& outcome) {
  outcome.inputs += progress.number - begin;
  outcome.refused += progress.refused;
  outcome.worst_memory_mb = std::max(outcome.worst_memory_mb, progress.memory_mb);
  if (progress.worst_cpu_s <= outcome.worst_cpu_s) return;
  outcome.worst_cpu_s = progress.worst_cpu_s;
  outcome.worst_number = progress.worst_number;
}

}  // namespace

Outcome run_inputs(const Parser& parser, const Campaign& campaign) {
  std::string name = (fs::temp_directory_path() / "rover-fuzz-XXXXXX").string();
  const fs::path dir = mkdtemp(name.data());
  const SharedProgress shared;
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::uint64_t next = campaign.first;
  while (next - campaign.first < campaign.inputs && elapsed_s() < campaign.seconds &&
         outcome.findings.size() < kMostFindings) {
    Progress& progress = *shared;
    progress = {};
    progress.number = next;
    const std::uint64_t end = next + std::min(kBatch, campaign.inputs - (next - campaign.first));
    const pid_t child = fork();
    if (child < 0) throw std::bad_alloc();
    if (child == 0) run_batch(parser, campaign, end, dir, progress);
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0) {
      outcome.findings.push_back(keep(parser, campaign, progress.number, ending(status, progress), dir / "said"));
      ++progress.number;
    }
    add(progress, next, outcome);
    next = progress.number;
    fs::remove_all(dir / "files");
  }
  outcome.seconds = elapsed_s();
  fs::remove_all(dir);
  return outcome;
}

}  // namespace rover::fuzz
