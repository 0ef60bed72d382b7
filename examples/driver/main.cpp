#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <thread>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/node_main.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/vehicle_config.hpp"
#include "driver/driver.hpp"

namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string config_dir = rover::project_dir() + "/config";
  std::string bus;
  double pace = 1.0;
};

// Message time is this host's monotonic clock: it goes on when the driver is started again, and never jumps.
rover::Utime clock_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

void drive(example::Driver& driver, double pace) {
  const auto started = Clock::now();
  const rover::Utime first = (clock_now() / rover::kTickUs + 1) * rover::kTickUs;
  for (rover::Utime t = first; rover::keep_running(); t += rover::kTickUs) {
    const auto due = std::chrono::duration<double>(rover::to_seconds(t - first) / pace);
    std::this_thread::sleep_until(started + std::chrono::duration_cast<Clock::duration>(due));
    driver.tick(t);
  }
}

int run(const Arguments& arguments) {
  const std::string bus = arguments.bus.empty() ? rover::load_bus_url(arguments.config_dir) : arguments.bus;
  lcm::LCM lcm(bus);
  if (!lcm.good()) throw rover::ConfigError("bus: cannot join " + bus);
  example::DriverConfig config;
  config.boot_id = rover::boot_id_from_clock();
  example::Driver driver(config, rover::load_vehicle(arguments.config_dir),
                         rover::load_stereo_rig(arguments.config_dir, "loccam"), lcm);
  std::printf("example_driver: TICK, IMU, WHEEL_STATE, LOCCAM on %s\n", bus.c_str());
  std::fflush(stdout);
  drive(driver, arguments.pace);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("A rover on a painted plane, in place of a vehicle", "example_driver");
  app.add_option("--config", arguments.config_dir, "folder of the configuration")->capture_default_str();
  app.add_option("--bus", arguments.bus, "LCM URL instead of the one in bus.yaml");
  app.add_option("--pace", arguments.pace, "of message time against the clock; a vehicle's is 1")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  rover::catch_interrupts();
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example_driver: %s\n", error.what());
    return 2;
  }
}
