#include "tools/status/processes.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common/bus/child_process.hpp"

namespace rover::status {
namespace fs = std::filesystem;
namespace {

double ticks_to_s(double ticks) {
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// Process id; 0 if the service is down.
int s6_pid(const fs::path& service_dir) {
  std::istringstream output(output_of({"s6-svstat", "-o", "up,pid", service_dir.string()}).value_or(""));
  std::string up;
  int pid = 0;
  return output >> up >> pid && up == "true" ? pid : 0;
}

// boots/NAME counts the starts; exits/NAME has a line for each process that ended, "0 0" if it was stopped.
std::optional<int> restarts_of(const fs::path& run_dir, const std::string& service) {
  int starts = 0;
  if (!(std::ifstream(run_dir / "boots" / service) >> starts)) return std::nullopt;
  std::ifstream exits(run_dir / "exits" / service);
  int failed = 0;
  for (std::string line; std::getline(exits, line);) failed += line != "0 0" ? 1 : 0;
  return std::min(failed, starts - 1);  // one that cannot read its configuration is not started again
}

std::map<std::string, ProcessFigures> s6_services(const fs::path& run_dir) {
  std::map<std::string, ProcessFigures> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run_dir / "services", error)) {
    const std::string name = entry.path().filename();
    if (name.front() == '.') continue;  // internal folders of s6-svscan
    ProcessFigures& figures = out[name];
    figures.pid = s6_pid(entry.path());
    figures.restarts = restarts_of(run_dir, name);
  }
  return out;
}

}  // namespace

ProcessUsage usage_of(int pid) {
  const std::string dir = "/proc/" + std::to_string(pid);
  std::ifstream stat(dir + "/stat");
  const std::string line{std::istreambuf_iterator<char>(stat), {}};
  const size_t name_end = line.rfind(')');  // the name may contain spaces
  if (pid <= 0 || name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  char state = 0;
  fields >> state;
  if (state == 'Z' || state == 'X') return {};
  std::string skipped;
  for (int field = 4; field < 14; ++field) fields >> skipped;  // proc(5): utime is field 14
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  double pages_total = 0.0;
  double pages_resident = 0.0;
  std::ifstream(dir + "/statm") >> pages_total >> pages_resident;
  return {true, ticks_to_s(user + system), pages_resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6};
}

void Processes::sample(const std::map<std::string, int>& reported_pids, double wall_s) {
  figures_ = run_dir_.empty() ? std::map<std::string, ProcessFigures>{} : s6_services(run_dir_);
  for (const auto& [name, pid] : reported_pids)
    if (const auto [it, added] = figures_.try_emplace(name); added) it->second.pid = pid;
  std::map<int, UsageSample> samples;
  for (auto& [name, figures] : figures_) measure(figures, wall_s, samples);
  previous_ = std::move(samples);
}

void Processes::measure(ProcessFigures& figures, double wall_s, std::map<int, UsageSample>& samples) const {
  const ProcessUsage usage = usage_of(figures.pid);
  figures.alive = usage.exists;
  if (!usage.exists) return;
  figures.rss_mb = usage.rss_mb;
  samples[figures.pid] = {usage.cpu_s, wall_s};
  const auto before = previous_.find(figures.pid);
  if (before == previous_.end() || wall_s <= before->second.wall_s) return;
  figures.cpu_percent = 100.0 * (usage.cpu_s - before->second.cpu_s) / (wall_s - before->second.wall_s);
}

}  // namespace rover::status
