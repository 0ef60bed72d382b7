#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/bus/bus_url.hpp"
#include "common/bus/channel_filter.hpp"
#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "rover_simulator/setup.hpp"

namespace {

struct Arguments {
  std::string config_dir = rover::project_dir() + "/config";
  std::string scenario;
  std::string bus;
  std::string run_dir;
  std::string picture;
  std::uint64_t seed = 1;
  rover::SimulatorOptions options;
};

int simulate(const Arguments& arguments) {
  const rover::Scenario scenario = rover::load_scenario(arguments.scenario);
  if (!arguments.picture.empty()) {
    rover::write_orbital_picture(scenario, arguments.seed, arguments.picture);
    return 0;
  }
  const auto rover_and_world = rover::make_simulated_rover(scenario, arguments.config_dir, arguments.seed);
  lcm::LCM lcm(arguments.bus);
  lcm::LCM reports(rover::reports_url(arguments.bus));
  if (!lcm.good() || !reports.good()) throw rover::ConfigError("bus: cannot join " + arguments.bus);
  rover::Simulator simulator(rover::with_scenario(arguments.options, scenario), *rover_and_world, lcm, &reports);
  if (const auto address = rover::parse_udpm(arguments.bus)) {
    std::vector<std::string> inputs;
    for (const auto& [channel, count] : simulator.malformed()) inputs.push_back(channel);
    if (!rover::keep_channels(inputs, address->port)) std::printf("WARN rover_simulator BUS_NOT_FILTERED\n");
  }
  const rover::SimulationSummary summary = simulator.run(rover::keep_running);
  for (const std::string& left : summary.left) std::printf("%s\n", left.c_str());
  if (!arguments.run_dir.empty()) rover::write_summary(arguments.run_dir, summary);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("rover_simulator: the world, its vehicle and its clock");
  app.add_option("--config", arguments.config_dir, "folder of the configuration")->capture_default_str();
  app.add_option("--scenario", arguments.scenario, "scenario file")->required();
  app.add_option("--bus", arguments.bus, "LCM URL")->required();
  app.add_option("--run-dir", arguments.run_dir, "the run's folder, for the summary");
  app.add_option("--orbital-picture", arguments.picture, "render the world from orbit to this file (GeoTIFF), and end");
  app.add_option("--seed", arguments.seed, "seed of everything random")->capture_default_str();
  app.add_option("--participants", arguments.options.participants, "services that the ticks wait for")->delimiter(',');
  app.add_option("--boot-id", arguments.options.boot_id, "start number");
  app.add_flag("--allow-injection", arguments.options.allow_injection, "obey INJECT");
  CLI::Option* realtime = app.add_flag("--realtime", arguments.options.realtime, "pace by the clock");
  app.add_option("--pace", arguments.options.pace, "slower or faster than the clock, for machines that cannot keep up")
      ->needs(realtime)
      ->check(CLI::Range(0.05, 10.0))
      ->capture_default_str();
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  rover::catch_interrupts();
  try {
    return simulate(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rover_simulator: %s\n", error.what());
    return 2;
  }
}
