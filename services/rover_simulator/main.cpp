#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/bus/bus_url.hpp"
#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/vehicle_config.hpp"
#include "rover_simulator/simulator.hpp"
#include "rover_simulator/world/scenario.hpp"

namespace {

struct Arguments {
  std::string config_dir = rover::project_dir() + "/config";
  std::string scenario;
  std::string bus;
  std::string run_dir;
  std::uint64_t seed = 1;
  rover::SimulatorOptions options;
};

rover::SimulatedRoverConfig rover_config(const rover::Scenario& scenario, std::uint64_t seed) {
  rover::SimulatedRoverConfig config;
  config.vehicle.gravity_mps2 = scenario.gravity_mps2;
  config.loccam.calibration_error_px = scenario.calibration_error_px;
  config.loccam.scene.appearance.sun_elevation_rad = scenario.sun_elevation_rad;
  config.loccam.scene.appearance.sun_azimuth_rad = scenario.sun_azimuth_rad;
  config.loccam.scene.appearance.seed = seed;
  config.start_sigma_m = scenario.start.sigma_m;
  config.start_sigma_yaw_rad = scenario.start.sigma_yaw_rad;
  return config;
}

void write_summary(const std::string& run_dir, const rover::SimulationSummary& summary) {
  const nlohmann::json json = {{"outcome", summary.outcome},
                               {"deterministic", summary.deterministic},
                               {"simulated_s", summary.simulated_s},
                               {"wall_s", summary.wall_s},
                               {"left", summary.left}};
  std::ofstream(run_dir + "/simulation.json.new") << json.dump(2) << "\n";
  std::filesystem::rename(run_dir + "/simulation.json.new", run_dir + "/simulation.json");
}

rover::StereoRig load_rig(const std::string& config_dir, const std::string& camera) {
  const rover::StereoRig rig = rover::load_stereo_rig(config_dir, camera);
  const std::string problem = rover::problem_of_rendering(rig);
  if (!problem.empty()) throw rover::ConfigError(config_dir + "/cameras.yaml: " + camera + ": " + problem);
  return rig;
}

int simulate(Arguments& arguments) {
  const rover::Scenario scenario = rover::load_scenario(arguments.scenario);
  const rover::Vehicle vehicle = rover::load_vehicle(arguments.config_dir);
  const rover::StereoRig loccam = load_rig(arguments.config_dir, "loccam");
  auto world = std::make_unique<rover::World>(scenario.world, scenario.dtm, arguments.seed);
  rover::SimulatedRoverConfig config = rover_config(scenario, arguments.seed);
  if (vehicle.pan_tilt) config.navcam = load_rig(arguments.config_dir, "navcam");
  rover::SimulatedRover rover_and_world(config, vehicle, loccam, std::move(world), scenario.start_pose(),
                                        arguments.seed);
  lcm::LCM lcm(arguments.bus);
  lcm::LCM reports(rover::reports_url(arguments.bus));
  if (!lcm.good() || !reports.good()) throw rover::ConfigError("bus: cannot join " + arguments.bus);
  arguments.options.end.timeout_s = scenario.timeout_s;
  arguments.options.faults = scenario.faults;
  rover::Simulator simulator(arguments.options, rover_and_world, lcm, &reports);
  const rover::SimulationSummary summary = simulator.run(rover::keep_running);
  for (const std::string& left : summary.left) std::printf("%s\n", left.c_str());
  if (!arguments.run_dir.empty()) write_summary(arguments.run_dir, summary);
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
