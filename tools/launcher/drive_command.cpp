#include "tools/launcher/drive_command.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "tools/launcher/arguments.hpp"
#include "tools/launcher/drive_folder.hpp"
#include "tools/launcher/drive_watch.hpp"
#include "tools/launcher/preflight.hpp"
#include "tools/launcher/progress.hpp"
#include "tools/launcher/run_report.hpp"
#include "tools/launcher/s6_tree.hpp"

namespace rover {
namespace {

// Error before the drive started: exit status 2, and the folder is removed.
struct NotStarted {
  std::string why;
};

std::vector<std::string> services_of(const DriveArguments& arguments) {
  return service_names(arguments.level != "efficient");
}

std::vector<ServiceCommand> service_commands(const DriveArguments& arguments) {
  std::vector<ServiceCommand> commands;
  for (const std::string& name : services_of(arguments)) commands.push_back({name});
  return commands;
}

void check_machine(const DriveArguments& arguments, const RunFolder& folder, const BusLock& lock) try {
  require_programs(services_of(arguments), arguments.bin_dir);
  require_usable_bus(folder.bus_url, lock);
} catch (const ConfigError& error) {
  throw NotStarted{error.what()};
}

// The first service that failed; waits for its last log line.
class FailureWatch {
 public:
  explicit FailureWatch(std::string run_dir) : run_dir_(std::move(run_dir)) {}
  std::optional<std::string> look() {
    constexpr int kMaxEmptyLooks = 100;
    const auto failed = failed_services(run_dir_);
    if (failed.empty() || (failed.front().last_log_line.empty() && ++empty_looks_ <= kMaxEmptyLooks)) return {};
    return failed.front().line();
  }

 private:
  std::string run_dir_;
  int empty_looks_ = 0;
};

void handle_for(lcm::LCM& lcm, std::chrono::milliseconds period) {
  const auto until = std::chrono::steady_clock::now() + period;
  for (auto left = period; left.count() > 0 && keep_running();
       left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()))
    lcm.handleTimeout(static_cast<int>(left.count()));
}

// Returns at the end of the drive; throws NotStarted or ConfigError.
void supervise(const DriveArguments& arguments, const RunFolder& folder, S6Session& session) {
  constexpr double kTickTimeoutS = 2.0;
  lcm::LCM lcm(folder.bus_url);
  DriveWatch watch(lcm);
  Progress progress(lcm);
  FailureWatch failures(folder.dir);
  bool timeout_reported = false;
  while (keep_running()) {
    handle_for(lcm, std::chrono::milliseconds(100));
    progress.show();
    if (const auto failure = failures.look()) {
      if (progress.started()) throw ConfigError(*failure);
      throw NotStarted{*failure};
    }
    if (!session.running()) throw std::runtime_error("s6-svscan has ended; see " + folder.dir + "/service_logs/s6.log");
    if (!watch.ticks_received() && watch.tick_age_s() > arguments.timeout_s)
      throw NotStarted{"drive: no TICK on " + folder.bus_url + " within " +
                       std::to_string(static_cast<int>(arguments.timeout_s)) +
                       " s. Start the vehicle's driver on this bus (to try it out: build/bin/example_driver); "
                       "./rover conform checks it"};
    if (const std::string problem = watch.driver_problem(); !problem.empty()) throw NotStarted{"drive: " + problem};
    const bool silent = watch.ticks_received() && watch.tick_age_s() > kTickTimeoutS;
    if (silent && !timeout_reported) std::printf("\nno TICK: message time has stopped\n");
    timeout_reported = silent;
    if (progress.supervisor_hangs()) {
      kill_service(folder.dir, "supervisor");
      progress.supervisor_killed();
    }
    if (watch.stationary_at_goal() && (arguments.until_goal || watch.stop_commanded())) break;
  }
  progress.finish();
}

int report(const DriveArguments& arguments, const RunFolder& folder) {
  if (!make_report(arguments.bin_dir, folder)) return 1;
  const nlohmann::json metrics = read_metrics(folder);
  const auto number = [&](const char* key, int decimals = 0) { return figure(metrics, key, decimals); };
  const std::string outcome = metrics.value("outcome", "unknown");
  const bool truth = metrics.value("truth", false);
  std::printf("%s: %s m driven for %s m planned in %s s, %s repairs, %s hazard stops%s\n", outcome.c_str(),
              number("driven_length_m", 1).c_str(), number("planned_length_m", 1).c_str(), number("duration_s").c_str(),
              number("replans").c_str(), number("hazard_stops").c_str(),
              truth ? "" : "; no ground truth: evaluated with the rover's own estimate");
  std::printf("report: %s/report.html\n", folder.dir.c_str());
  return outcome == "goal_reached" ? 0 : 1;
}

int drive_in(const DriveArguments& arguments, const RunFolder& folder) {
  catch_interrupts();
  std::printf("run: %s\n", folder.dir.c_str());
  if (const std::string line = page_line(folder.config_dir); !line.empty()) std::printf("%s\n", line.c_str());
  for (const std::string& note : folder.map_notes) std::printf("%s\n", note.c_str());
  std::fflush(stdout);
  write_json(folder.dir + "/launch.json", {{"bus", folder.bus_url}, {"allow_injection", false}});
  write_s6_tree(folder.dir, service_commands(arguments), false);
  {
    S6Session session(folder, arguments.bin_dir);
    supervise(arguments, folder, session);
    session.stop();
  }
  write_json(folder.dir + "/run.json", {{"scenario", "drive"},
                                        {"commit", commit_of(arguments.source_dir)},
                                        {"realtime", true},
                                        {"interrupted", !keep_running()},
                                        {"outcome", "stopped"}});
  return report(arguments, folder);
}

}  // namespace

int drive(const DriveArguments& arguments) {
  const RunFolder folder = make_drive_folder(arguments);
  const BusLock lock(folder.bus_url);
  try {
    check_machine(arguments, folder, lock);
    return drive_in(arguments, folder);
  } catch (const NotStarted& problem) {
    remove_run_folder(folder);
    std::fprintf(stderr, "%s\n", in_users_files(problem.why, folder, arguments).c_str());
    return 2;
  } catch (const ConfigError& error) {  // of a service, after the drive has started
    std::fprintf(stderr, "%s\n", in_users_files(error.what(), folder, arguments).c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace rover
