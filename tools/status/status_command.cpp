#include "tools/status/status_command.hpp"

#include <algorithm>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>

#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/wall_clock.hpp"
#include "tools/status/listener.hpp"
#include "tools/status/processes.hpp"
#include "tools/status/running_run.hpp"
#include "tools/status/snapshot_json.hpp"
#include "tools/status/terminal.hpp"

namespace rover::status {
namespace {

// HEARTBEAT comes every 0.2 s of message time: sample the processes when most services have sent one.
constexpr double kFirstSampleS = 0.3;
constexpr double kListenS = 1.2;
constexpr double kRefreshS = 1.0;
constexpr int kMoreRefreshes = 3;

lcm::LCM& joined(lcm::LCM& lcm, const Target& target) {
  if (!lcm.good()) throw ConfigError("bus: cannot join " + target.bus_url);
  return lcm;
}

// Observes one rover.
class Observer {
 public:
  explicit Observer(const Target& target)
      : target_(target),
        lcm_(target.bus_url),
        listener_(joined(lcm_, target_), statistics_, wall_s),
        processes_(target.run_dir) {}

  void listen(double seconds) {
    if (!listener_.listen_until(wall_s() + seconds, keep_running))
      throw ConfigError("bus: " + target_.bus_url + " has failed");
    processes_.sample(statistics_.pids(), wall_s());
  }
  Snapshot snapshot() const {
    Snapshot out = statistics_.snapshot(processes_.figures(), wall_s());
    out.run_dir = target_.run_dir;
    out.bus_url = target_.bus_url;
    return out;
  }
  bool over() const { return !target_.run_dir.empty() && !is_running(target_.run_dir); }

 private:
  Target target_;
  lcm::LCM lcm_;
  BusStatistics statistics_;
  Listener listener_;
  Processes processes_;
};

bool lacks_figures(const Snapshot& snapshot) {
  return std::any_of(snapshot.faults.begin(), snapshot.faults.end(),
                     [](const FaultStatus& fault) { return fault.report.utime == kNever; });
}

int watch(Observer& observer) {
  catch_interrupts();
  {
    Terminal terminal;
    while (keep_running() && !observer.over()) {
      terminal.redraw(screen(observer.snapshot(), terminal.options()));
      observer.listen(kRefreshS);
    }
  }
  if (keep_running()) std::printf("the run is over\n");
  return 0;
}

}  // namespace

int show_status(const StatusArguments& arguments) {
  const std::optional<Target> target = find_target(arguments.target);
  if (!target) return 1;
  Observer observer(*target);
  observer.listen(kFirstSampleS);
  if (arguments.watch) return watch(observer);
  observer.listen(kListenS - kFirstSampleS);
  // Active faults are repeated each second of message time, which takes longer on a loaded machine.
  for (int more = 0; more < kMoreRefreshes && lacks_figures(observer.snapshot()); ++more) observer.listen(kRefreshS);
  const Snapshot snapshot = observer.snapshot();
  if (target->run_dir.empty() && snapshot.channels.empty()) {
    std::fprintf(stderr, "no rover is running: no messages received on %s\n", target->bus_url.c_str());
    return 1;
  }
  if (arguments.json) {
    std::printf("%s\n",
                to_json(snapshot).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
  } else {
    std::fputs(screen(snapshot, {.colours = on_terminal()}).c_str(), stdout);
  }
  return 0;
}

}  // namespace rover::status
