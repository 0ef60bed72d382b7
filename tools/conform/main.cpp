// ./rover conform: checks a driver against the requirements of the stack.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/node_main.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/bus/wall_clock.hpp"
#include "tools/conform/listener.hpp"
#include "tools/conform/table.hpp"
#include "tools/conform/trial_publisher.hpp"

namespace {

using namespace rover;
using namespace rover::conform;

struct Arguments {
  std::string config_dir = project_dir() + "/config";
  std::string bus;
  bool move = false;
  double listen_s = 10.0;
  double timeout_s = 10.0;
};

class ConformanceTest {
 public:
  ConformanceTest(const Arguments& arguments, const StereoRig& loccam, lcm::LCM& lcm)
      : arguments_(arguments), loccam_(loccam), lcm_(lcm), listener_(lcm, wall_s) {}

  std::vector<Line> run() {
    wait_for_driver();
    std::printf("listening for %.0f s; the rover must be stationary\n", arguments_.listen_s);
    std::fflush(stdout);
    listener_.take();
    handle_until([this] { return listened_s() >= arguments_.listen_s; });
    const Received at_rest = listener_.take();
    if (at_rest.stack && arguments_.move)
      throw ConfigError("conform: the stack is running on this bus; stop ./rover drive before --move");
    std::vector<Line> lines = check_time(at_rest);
    add(lines, at_rest.stack
                   ? std::vector{skipped("contents, commands", "the stack is running: the rover may drive", "")}
                   : check_content(at_rest, loccam_));
    if (!at_rest.stack) add(lines, trial());
    return lines;
  }

 private:
  static void add(std::vector<Line>& lines, const std::vector<Line>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  }

  // In message time: a slow driver takes longer.
  double listened_s() const {
    const auto& ticks = listener_.received().ticks;
    return ticks.empty() ? 0.0 : to_seconds(ticks.back().stamp.utime - ticks.front().stamp.utime);
  }

  // Timeout if ticks stop.
  template <class Over>
  void handle_until(Over over) {
    Utime last = listener_.now();
    double since = wall_s();
    while (keep_running() && !over()) {
      lcm_.handleTimeout(20);
      if (listener_.now() != last) {
        last = listener_.now();
        since = wall_s();
      }
      if (wall_s() - since > arguments_.timeout_s) return;
    }
    if (!keep_running()) throw ConfigError("conform: interrupted");
  }

  void wait_for_driver() {
    const double begun = wall_s();
    handle_until([&] { return listener_.now() != kNever || wall_s() - begun > arguments_.timeout_s; });
    if (listener_.now() != kNever) return;
    throw ConfigError("conform: no TICK within " + std::to_string(static_cast<int>(arguments_.timeout_s)) +
                      " s. Start the driver (to try it out: build/bin/example_driver), on the same bus");
  }

  void warn() {
    std::printf(
        "WARNING: the rover will move about 0.4 m forward in 5 s. Lift its wheels or clear its path; "
        "Ctrl-C stops.\n");
    std::fflush(stdout);
    const Utime from = listener_.now();
    handle_until([&] { return listener_.now() - from > 5'000'000; });
    listener_.take();
  }

  std::vector<Line> trial() {
    if (arguments_.move) warn();
    const Trial trial({.move = arguments_.move}, listener_.now() + kTickUs);
    TrialPublisher publisher(lcm_, boot_id_from_clock());
    Utime last_tick = kNever;
    handle_until([&] {
      if (listener_.now() != last_tick) publisher.publish(trial, last_tick = listener_.now());
      return trial.over(last_tick);
    });
    return check_trial(listener_.take(), trial);
  }

  Arguments arguments_;
  StereoRig loccam_;
  lcm::LCM& lcm_;
  Listener listener_;
};

int examine(const Arguments& arguments) {
  const std::string bus = arguments.bus.empty() ? load_bus_url(arguments.config_dir) : arguments.bus;
  const StereoRig loccam = load_stereo_rig(arguments.config_dir, "loccam");
  lcm::LCM lcm(bus);
  if (!lcm.good()) throw ConfigError("bus: cannot join " + bus);
  ConformanceTest examination(arguments, loccam, lcm);
  const std::vector<Line> lines = examination.run();
  std::printf("%s", table(lines, isatty(STDOUT_FILENO) == 1).c_str());
  const int failed = failures(lines);
  if (failed > 0)
    std::printf("%d of %zu requirements are not met; see docs/drivers.md\n", failed, lines.size());
  else
    std::printf("the driver meets all requirements%s\n", arguments.move ? "" : " (those of its wheels require --move)");
  return failed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "./rover conform: checks a running driver against the requirements of docs/drivers.md.\n"
      "Example: ./rover conform --move");
  app.name("./rover conform");
  app.add_option("--config", arguments.config_dir, "configuration folder (cameras.yaml, bus.yaml)")
      ->transform(is_user_path())
      ->capture_default_str();
  app.add_option("--bus", arguments.bus, "LCM URL instead of the one in bus.yaml")->check(is_bus_url());
  app.add_flag("--move", arguments.move, "also send commands: the rover moves about 0.4 m");
  app.add_option("--listen", arguments.listen_s, "seconds to listen")
      ->check(CLI::Range(2.0, 600.0))
      ->capture_default_str();
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parse(app, error);
  }
  catch_interrupts();
  try {
    return examine(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
