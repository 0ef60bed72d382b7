#include "status/status_command.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>

#include "common/bus/config.hpp"
#include "common/bus/node_main.hpp"
#include "status/listener.hpp"
#include "status/processes.hpp"
#include "status/running_run.hpp"
#include "status/snapshot_json.hpp"
#include "status/terminal.hpp"

namespace rover::status {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) {
  interrupted = 1;
}

bool going() {
  return interrupted == 0;
}

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Heartbeats come each 0.2 s of message time: the first look at processes comes when most have been heard.
constexpr double kFirstLookS = 0.3;
constexpr double kListenS = 1.2;
constexpr double kRefreshS = 1.0;
constexpr int kMoreRefreshes = 3;

struct Target {
  std::string run_dir;  // empty: none
  std::string bus_url;
};

// Empty where nothing runs; says so.
std::optional<Target> find_target(const StatusArguments& arguments) {
  if (!arguments.run.empty() && !std::filesystem::is_directory(arguments.run))
    throw ConfigError(arguments.run + ": no such run folder");
  const std::optional<std::string> run = arguments.run.empty()       ? newest_running(arguments.logs_dir)
                                         : is_running(arguments.run) ? std::optional(arguments.run)
                                                                     : std::nullopt;
  if (run) {
    const std::string dir = std::filesystem::canonical(*run);
    const std::string own_bus = load_bus_url(dir + "/config");
    // A bus named by hand is not that of a run that happens to be there too.
    const bool other_bus = arguments.run.empty() && !arguments.bus.empty() && arguments.bus != own_bus;
    return other_bus ? Target{"", arguments.bus} : Target{dir, arguments.bus.empty() ? own_bus : arguments.bus};
  }
  if (arguments.run.empty() && !arguments.bus.empty()) return Target{"", arguments.bus};
  if (arguments.run.empty()) {
    std::fprintf(stderr,
                 "no rover runs: no services are kept in %s. Start one with ./rover run, or name a bus: --bus\n",
                 arguments.logs_dir.c_str());
  } else {
    std::fprintf(stderr, "%s: no services run there\n", arguments.run.c_str());
  }
  return std::nullopt;
}

lcm::LCM& joined(lcm::LCM& lcm, const Target& target) {
  if (!lcm.good()) throw ConfigError("bus: cannot join " + target.bus_url);
  return lcm;
}

// One rover under observation.
class Observer {
 public:
  explicit Observer(const Target& target)
      : target_(target),
        lcm_(target.bus_url),
        listener_(joined(lcm_, target_), account_, wall_s),
        processes_(target.run_dir) {}

  void listen(double seconds) {
    if (!listener_.listen_until(wall_s() + seconds, going))
      throw ConfigError("bus: " + target_.bus_url + " has failed");
    processes_.look(account_.pids(), wall_s());
  }
  Snapshot snapshot() const {
    Snapshot out = account_.snapshot(processes_.figures(), wall_s());
    out.run_dir = target_.run_dir;
    out.bus_url = target_.bus_url;
    return out;
  }
  bool over() const { return !target_.run_dir.empty() && !is_running(target_.run_dir); }

 private:
  Target target_;
  lcm::LCM lcm_;
  Account account_;
  Listener listener_;
  Processes processes_;
};

bool lacks_figures(const Snapshot& snapshot) {
  return std::any_of(snapshot.faults.begin(), snapshot.faults.end(),
                     [](const FaultStatus& fault) { return fault.report.utime == kNever; });
}

int watch(Observer& observer) {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  {
    Terminal terminal;
    while (going() && !observer.over()) {
      terminal.redraw(observer.snapshot());
      observer.listen(kRefreshS);
    }
  }
  if (going()) std::printf("the run is over\n");
  return 0;
}

}  // namespace

int show_status(const StatusArguments& arguments) {
  const std::optional<Target> target = find_target(arguments);
  if (!target) return 1;
  Observer observer(*target);
  observer.listen(kFirstLookS);
  if (arguments.watch) return watch(observer);
  observer.listen(kListenS - kFirstLookS);
  // Standing faults are told again each second of message time, which a busy machine stretches.
  for (int more = 0; more < kMoreRefreshes && lacks_figures(observer.snapshot()); ++more) observer.listen(kRefreshS);
  const Snapshot snapshot = observer.snapshot();
  if (target->run_dir.empty() && snapshot.channels.empty()) {
    std::fprintf(stderr, "no rover runs: nothing was heard on %s\n", target->bus_url.c_str());
    return 1;
  }
  if (arguments.json) {
    std::printf("%s\n",
                to_json(snapshot).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
  } else {
    print_once(snapshot);
  }
  return 0;
}

}  // namespace rover::status
