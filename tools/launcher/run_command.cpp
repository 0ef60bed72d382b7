#include "tools/launcher/run_command.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/bus/child.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "tools/launcher/preflight.hpp"
#include "tools/launcher/progress.hpp"
#include "tools/launcher/run_folder.hpp"
#include "tools/launcher/run_report.hpp"
#include "tools/launcher/s6_tree.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> services_of(const RunFolder& folder) {
  return service_names(folder.level != "efficient");
}

bool allows_injection(const RunArguments& arguments, const RunFolder& folder) {
  return arguments.allow_injection || folder.has_faults;
}

std::vector<ServiceCommand> service_commands(const RunArguments& arguments, const RunFolder& folder) {
  std::vector<ServiceCommand> commands;
  std::string participants;
  for (const std::string& name : services_of(folder)) {
    commands.push_back({name});
    participants += (participants.empty() ? "" : ",") + name;
  }
  const std::string flags = "--scenario \"$ROVER_RUN/config/scenario.yaml\" --seed " + std::to_string(folder.seed) +
                            " --participants " + participants + (arguments.realtime ? " --realtime" : "");
  commands.push_back({"rover_simulator", flags, true});
  return commands;
}

enum class End { kOver, kFailed, kNotStarted };

constexpr double kPollS = 0.05;
constexpr double kStopS = 10.0;
constexpr int kRefused = 2;  // exit status of a program that refuses its configuration

End wait_for_end(const RunFolder& folder, S6Session& session) {
  lcm::LCM lcm(folder.bus_url);
  Progress progress(lcm);
  const std::string end_file = folder.dir + "/simulation.json";
  // On a busy machine a service may end before its logger has started.
  constexpr int kMaxEmptyLooks = 100;
  int empty_looks = 0;
  while (keep_running()) {
    lcm.handleTimeout(100);
    progress.show();
    if (progress.supervisor_hangs()) {
      kill_service(folder.dir, "supervisor");
      progress.supervisor_killed();
    }
    if (fs::exists(end_file)) break;
    const auto failed = failed_services(folder.dir);
    if (!failed.empty() && (!failed.front().last_log_line.empty() || ++empty_looks > kMaxEmptyLooks))
      return progress.started() ? End::kFailed : End::kNotStarted;
    if (!session.running()) {
      std::fprintf(stderr, "s6-svscan has ended; see %s/service_logs/s6.log\n", folder.dir.c_str());
      return End::kFailed;
    }
  }
  progress.finish();
  return End::kOver;
}

// Several services may fail on the same value; report one.
void report_failure(const FailedService& failed, const RunArguments& arguments, const RunFolder& folder) {
  std::fprintf(stderr, "%s\n", in_users_files(failed.line(), folder, arguments.source_dir + "/config").c_str());
}

// Run metadata for the report.
void write_run_json(const RunArguments& arguments, const RunFolder& folder) {
  const nlohmann::json facts = {{"scenario", scenario_name(arguments.scenario)},
                                {"seed", folder.seed},
                                {"commit", commit_of(arguments.source_dir)},
                                {"level", folder.level},
                                {"perception", arguments.perception},
                                {"realtime", arguments.realtime},
                                {"interrupted", !keep_running()}};
  write_json(folder.dir + "/run.json", facts);
}

// Read by ./rover inject during the run.
void write_launch_json(const RunArguments& arguments, const RunFolder& folder) {
  const nlohmann::json facts = {{"bus", folder.bus_url}, {"allow_injection", allows_injection(arguments, folder)}};
  write_json(folder.dir + "/launch.json", facts);
}

End run_processes(const RunArguments& arguments, const RunFolder& folder) {
  write_launch_json(arguments, folder);
  write_s6_tree(folder.dir, service_commands(arguments, folder), allows_injection(arguments, folder));
  S6Session session(folder, arguments.bin_dir);
  const End end = wait_for_end(folder, session);
  session.stop();
  return end;
}

// Without cameras, and without a bus that others could join. A configuration that is refused is one line.
End run_one_process(const RunArguments& arguments, const RunFolder& folder) {
  std::vector<std::string> command = {arguments.bin_dir + "/rover_one_process",
                                      "--config",
                                      folder.config_dir,
                                      "--scenario",
                                      folder.scenario,
                                      "--run-dir",
                                      folder.dir,
                                      "--seed",
                                      std::to_string(folder.seed),
                                      "--perception",
                                      arguments.perception};
  if (folder.level != "efficient") command.emplace_back("--full");
  const std::string log = folder.dir + "/service_logs/rover_one_process.log";
  Child child(command, log);
  while (child.running() && keep_running()) sleep_s(kPollS);
  child.end(kStopS);
  if (fs::exists(folder.dir + "/simulation.json")) return End::kOver;
  const bool refused = child.status() == kRefused;
  const std::string line = refused ? last_line(log) : "the run failed: " + status_text(child.status()) + "; see " + log;
  std::fprintf(stderr, "%s\n", in_users_files(line, folder, arguments.source_dir + "/config").c_str());
  return refused ? End::kNotStarted : End::kFailed;
}

// Faults of processes, channels and images need processes, a bus and images.
void require_possible(const RunArguments& arguments, const RunFolder& folder) {
  if (arguments.perception == "rendered") return;
  const std::string with = "--perception " + arguments.perception + ": ";
  if (folder.has_faults) throw ConfigError(with + "the scenario has faults, which need --perception rendered");
  if (arguments.realtime) throw ConfigError(with + "not with --realtime");
  if (arguments.allow_injection) throw ConfigError(with + "not with --allow-injection");
}

void print_result(const RunFolder& folder, const nlohmann::json& metrics) {
  const auto number = [&](const char* key, int decimals = 0) { return figure(metrics, key, decimals); };
  std::printf(
      "%s: %s m driven for %s m planned in %s s, %s repairs, %s hazard stops, %s collisions, "
      "drift %s %%, %s times real time\n",
      metrics.value("outcome", "unknown").c_str(), number("driven_length_m", 1).c_str(),
      number("planned_length_m", 1).c_str(), number("duration_s").c_str(), number("replans").c_str(),
      number("hazard_stops").c_str(), number("collisions").c_str(), number("odometry_drift_percent", 2).c_str(),
      number("realtime_factor", 1).c_str());
  std::printf("report: %s/report.html\n", folder.dir.c_str());
}

}  // namespace

RunResult run(const RunArguments& given) {
  RunArguments arguments = given;
  arguments.scenario = scenario_file(given);
  RunResult result;
  RunFolder folder;
  try {
    folder = make_run_folder(arguments);
  } catch (const std::exception& error) {  // ConfigError, DtmError or filesystem_error
    std::fprintf(stderr, "%s\n", error.what());
    result.exit_status = 2;
    return result;
  }
  const bool rendered = arguments.perception == "rendered";
  std::optional<BusLock> lock;
  try {
    require_possible(arguments, folder);
    if (rendered) lock.emplace(folder.bus_url);
    require_programs(rendered ? services_of(folder) : std::vector<std::string>{"rover_one_process"}, arguments.bin_dir);
    if (rendered) require_usable_bus(folder.bus_url, *lock);
  } catch (const ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    remove_run_folder(folder);
    result.exit_status = 2;
    return result;
  }
  result.dir = folder.dir;
  catch_interrupts();
  std::printf("run: %s\n", folder.dir.c_str());
  if (const std::string line = page_line(folder.config_dir); rendered && !line.empty())
    std::printf("%s\n", line.c_str());
  for (const std::string& note : folder.map_notes) std::printf("%s\n", note.c_str());
  std::fflush(stdout);  // in a file, the last line is that of a failure
  const End end = rendered ? run_processes(arguments, folder) : run_one_process(arguments, folder);
  if (end != End::kOver) {
    const auto failed = failed_services(folder.dir);
    if (!failed.empty()) report_failure(failed.front(), arguments, folder);
    if (end == End::kNotStarted) {
      remove_run_folder(folder);
      result.dir.clear();
    }
    result.exit_status = !failed.empty() || (!rendered && end == End::kNotStarted) ? 2 : 1;
    return result;
  }
  write_run_json(arguments, folder);
  if (!make_report(arguments.bin_dir, folder)) return result;
  const nlohmann::json metrics = read_metrics(folder);
  print_result(folder, metrics);
  const bool success = metrics.value("outcome", "") == "goal_reached" && metrics.value("collisions", 1) == 0;
  result.exit_status = success ? 0 : 1;
  return result;
}

}  // namespace rover
