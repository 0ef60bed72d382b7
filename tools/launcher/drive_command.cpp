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

// What went wrong before the drive began: exit status 2, and no folder is left.
struct NotBegun {
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
  demand_programs(services_of(arguments), arguments.bin_dir);
  demand_bus(folder.bus_url, lock);
} catch (const ConfigError& error) {
  throw NotBegun{error.what()};
}

// The first service that ended for good; waits a while for its last words.
class FailureWatch {
 public:
  explicit FailureWatch(std::string run_dir) : run_dir_(std::move(run_dir)) {}
  std::optional<std::string> look() {
    constexpr int kSilentLooks = 100;
    const auto failed = failed_services(run_dir_);
    if (failed.empty() || (failed.front().said.empty() && ++silent_looks_ <= kSilentLooks)) return {};
    return failed.front().line();
  }

 private:
  std::string run_dir_;
  int silent_looks_ = 0;
};

void handle_for(lcm::LCM& lcm, std::chrono::milliseconds period) {
  const auto until = std::chrono::steady_clock::now() + period;
  for (auto left = period; left.count() > 0 && going();
       left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()))
    lcm.handleTimeout(static_cast<int>(left.count()));
}

// Returns where the drive is over; throws NotBegun or ConfigError.
void attend(const DriveArguments& arguments, const RunFolder& folder, S6Session& session) {
  constexpr double kTicksLostS = 2.0;
  lcm::LCM lcm(folder.bus_url);
  DriveWatch watch(lcm);
  Progress progress(lcm, true);
  FailureWatch failures(folder.dir);
  bool told_of_silence = false;
  while (going()) {
    handle_for(lcm, std::chrono::milliseconds(100));
    progress.show();
    if (const auto failure = failures.look()) {
      if (progress.started()) throw ConfigError(*failure);
      throw NotBegun{*failure};
    }
    if (!session.running()) throw std::runtime_error("s6-svscan has ended; see " + folder.dir + "/service_logs/s6.log");
    if (!watch.ticks_heard() && watch.silence_s() > arguments.patience_s)
      throw NotBegun{"drive: no TICK on " + folder.bus_url + " within " +
                     std::to_string(static_cast<int>(arguments.patience_s)) +
                     " s. Start the vehicle's driver on this bus (to try it out: build/bin/example_driver); "
                     "./rover conform checks it"};
    if (const std::string problem = watch.driver_problem(); !problem.empty()) throw NotBegun{"drive: " + problem};
    const bool silent = watch.ticks_heard() && watch.silence_s() > kTicksLostS;
    if (silent && !told_of_silence) std::printf("\nno TICK any more: the rover's time stands still\n");
    told_of_silence = silent;
    if (progress.supervisor_hangs()) {
      kill_service(folder.dir, "supervisor");
      progress.supervisor_killed();
    }
    if (watch.rests_at_goal() && (arguments.until_goal || watch.stop_ordered())) break;
  }
  progress.finish();
}

int report(const DriveArguments& arguments, const RunFolder& folder) {
  if (!make_report(arguments.bin_dir, folder)) return 1;
  const nlohmann::json metrics = read_metrics(folder);
  const auto number = [&](const char* key) { return figure(metrics, key); };
  const std::string outcome = metrics.value("outcome", "unknown");
  const bool truth = metrics.value("truth", false);
  std::printf("%s: %.1f m driven for %.1f m planned in %.0f s, %.0f repairs, %.0f hazard stops%s\n", outcome.c_str(),
              number("driven_length_m"), number("planned_length_m"), number("duration_s"), number("replans"),
              number("hazard_stops"), truth ? "" : "; no truth: by the rover's own estimate");
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
    attend(arguments, folder, session);
    session.stop();
  }
  write_json(folder.dir + "/run.json", {{"scenario", "drive"},
                                        {"commit", commit_of(arguments.source_dir)},
                                        {"realtime", true},
                                        {"interrupted", !going()},
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
  } catch (const NotBegun& problem) {
    remove_run_folder(folder);
    std::fprintf(stderr, "%s\n", in_users_files(problem.why, folder, arguments).c_str());
    return 2;
  } catch (const ConfigError& error) {  // a service that met it only after the drive had begun
    std::fprintf(stderr, "%s\n", in_users_files(error.what(), folder, arguments).c_str());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace rover
