#include "launcher/run_command.hpp"

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "common/bus/config.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "launcher/preflight.hpp"
#include "launcher/progress.hpp"
#include "launcher/run_folder.hpp"
#include "launcher/s6_tree.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) {
  interrupted = 1;
}

bool allows_injection(const RunArguments& arguments, const RunFolder& folder) {
  return arguments.allow_injection || folder.has_faults;
}

std::vector<ServiceCommand> service_commands(const RunArguments& arguments, const RunFolder& folder) {
  const std::string common = " --config '" + folder.config_dir + "' --bus '" + folder.bus_url + "' --run-dir '" +
                             folder.dir + "'" + (allows_injection(arguments, folder) ? " --allow-injection" : "");
  std::vector<ServiceCommand> commands;
  std::string participants;
  for (const std::string name : kServiceNames) {
    commands.push_back({name, "'" + arguments.bin_dir + "/" + name + "'" + common, false});
    participants += (participants.empty() ? "" : ",") + name;
  }
  commands.push_back({"rover_simulator",
                      "'" + arguments.bin_dir + "/rover_simulator'" + common + " --scenario '" + folder.scenario +
                          "' --seed " + std::to_string(folder.seed) + " --participants " + participants +
                          (arguments.realtime ? " --realtime" : ""),
                      true});
  return commands;
}

enum class End { kOver, kFailed, kNeverBegun };

End wait_for_end(const RunArguments& arguments, const RunFolder& folder, S6Session& session) {
  lcm::LCM lcm(folder.bus_url);
  Progress progress(lcm, !arguments.quiet);
  const std::string end_file = folder.dir + "/simulation.json";
  // On a busy machine a service may end before the logger of its words has started.
  constexpr int kSilentLooks = 100;
  int silent_looks = 0;
  while (!interrupted) {
    lcm.handleTimeout(100);
    progress.show();
    if (progress.supervisor_hangs()) {
      kill_service(folder.dir, "supervisor");
      progress.supervisor_killed();
    }
    if (fs::exists(end_file)) break;
    const auto failed = failed_services(folder.dir);
    if (!failed.empty() && (!failed.front().said.empty() || ++silent_looks > kSilentLooks))
      return progress.started() ? End::kFailed : End::kNeverBegun;
    if (!session.running()) {
      std::fprintf(stderr, "s6-svscan has ended; see %s/service_logs/s6.log\n", folder.dir.c_str());
      return End::kFailed;
    }
  }
  progress.finish();
  return End::kOver;
}

// Several services may stumble over the same value: one is told.
void tell(const FailedService& failed, const RunArguments& arguments, const RunFolder& folder) {
  const std::string line = failed.said.empty() ? failed.name + ": ended with exit status 2" : failed.said;
  std::fprintf(stderr, "%s\n", in_users_files(line, folder, arguments.source_dir + "/config").c_str());
}

nlohmann::json read_json(const std::string& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in, nullptr, false);
}

// The launcher's part of the run's facts, for the report.
void write_run_json(const RunArguments& arguments, const RunFolder& folder) {
  const nlohmann::json facts = {{"scenario", scenario_name(arguments.scenario)},
                                {"seed", folder.seed},
                                {"commit", commit_of(arguments.source_dir)},
                                {"level", arguments.level},
                                {"realtime", arguments.realtime},
                                {"interrupted", interrupted != 0}};
  std::ofstream(folder.dir + "/run.json") << facts.dump(2) << "\n";
}

// For ./rover inject, while the run lasts.
void write_launch_json(const RunArguments& arguments, const RunFolder& folder) {
  const nlohmann::json facts = {{"bus", folder.bus_url}, {"allow_injection", allows_injection(arguments, folder)}};
  std::ofstream(folder.dir + "/launch.json") << facts.dump(2) << "\n";
}

int make_report(const RunArguments& arguments, const RunFolder& folder) {
  const std::string command = "'" + arguments.bin_dir + "/rover_report' '" + folder.dir + "' > '" + folder.dir +
                              "/service_logs/report.log' 2>&1";
  return std::system(command.c_str());
}

void print_result(const RunFolder& folder, const nlohmann::json& metrics) {
  const auto number = [&](const char* key) {
    return metrics.contains(key) && metrics[key].is_number() ? metrics[key].get<double>() : 0.0;
  };
  std::printf(
      "%s: %.1f m driven for %.1f m planned in %.0f s, %.0f repairs, %.0f hazard stops, %.0f collisions, "
      "drift %.2f %%, %.1f times real time\n",
      metrics.value("outcome", "unknown").c_str(), number("driven_length_m"), number("planned_length_m"),
      number("duration_s"), number("replans"), number("hazard_stops"), number("collisions"),
      number("odometry_drift_percent"), number("realtime_factor"));
  std::printf("report: %s/report.html\n", folder.dir.c_str());
}

}  // namespace

RunResult run(const RunArguments& given) {
  RunArguments arguments = given;
  if (arguments.scenario.empty()) arguments.scenario = arguments.source_dir + "/config/scenarios/default.yaml";
  RunResult result;
  RunFolder folder;
  try {
    folder = make_run_folder(arguments);
  } catch (const std::exception& error) {  // ConfigError, DtmError, the file system's
    std::fprintf(stderr, "%s\n", error.what());
    result.exit_status = 2;
    return result;
  }
  const auto problems = bus_problems(folder.bus_url);
  for (const std::string& problem : problems) std::fprintf(stderr, "%s\n", problem.c_str());
  const BusLock lock(folder.bus_url);
  if (problems.empty() && !lock.held())
    std::fprintf(stderr, "bus: another rover runs on %s. Stop it, or give this one a bus: --bus udpm://...\n",
                 folder.bus_url.c_str());
  if (!problems.empty() || !lock.held()) {
    remove_run_folder(folder);
    result.exit_status = 2;
    return result;
  }
  result.dir = folder.dir;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  if (!arguments.quiet) std::printf("run: %s\n", folder.dir.c_str());
  if (const std::string line = page_line(folder.config_dir); !arguments.quiet && !line.empty())
    std::printf("%s\n", line.c_str());
  write_launch_json(arguments, folder);
  write_s6_tree(folder.dir, service_commands(arguments, folder));
  End end = End::kFailed;
  {
    S6Session session(folder.dir);
    end = wait_for_end(arguments, folder, session);
    session.stop();
  }
  if (end != End::kOver) {
    const auto failed = failed_services(folder.dir);
    if (!failed.empty()) tell(failed.front(), arguments, folder);
    if (end == End::kNeverBegun) {
      remove_run_folder(folder);
      result.dir.clear();
    }
    result.exit_status = failed.empty() ? 1 : 2;
    return result;
  }
  write_run_json(arguments, folder);
  if (make_report(arguments, folder) != 0) {
    std::fprintf(stderr, "the report failed; see %s/service_logs/report.log\n", folder.dir.c_str());
    return result;
  }
  const nlohmann::json metrics = read_json(folder.dir + "/metrics.json");
  if (!arguments.quiet) print_result(folder, metrics);
  const bool success = metrics.value("outcome", "") == "goal_reached" && metrics.value("collisions", 1) == 0;
  result.exit_status = success ? 0 : 1;
  return result;
}

}  // namespace rover
