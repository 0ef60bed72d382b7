// Simulator and all services in one process on an in-memory bus: a run without cameras, faster than with them.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/bus/command_line.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/navigation_config.hpp"
#include "common/bus/service_names.hpp"
#include "rover_simulator/setup.hpp"
#include "tools/one_process/services.hpp"
#include "tools/one_process/stand_ins.hpp"
#include "tools/truth_perception/nodes.hpp"

namespace {

struct Arguments {
  std::string config_dir;
  std::string scenario;
  std::string run_dir;
  std::string perception = "geometric";
  std::uint64_t seed = 1;
  bool with_full = false;  // the services of the Full level as well
};

// What a run shares in place of cameras.
struct Perception {
  Perception(const rover::SimulatedRover& rover, const rover::GroundAppearanceConfig& appearance, std::uint64_t seed,
             const std::string& config_dir)
      : geometric(rover, appearance, seed),
        truth{std::make_shared<rover::truth::TrueSurface>(rover.world()), config_dir} {}

  rover::GeometricPerception geometric;
  rover::truth::TruthPerception truth;
};

// The service, or its substitute at this tier of perception.
rover::Stack::Factory factory(const std::string& service, const Arguments& arguments, Perception& perception) {
  const std::string& config_dir = arguments.config_dir;
  if (arguments.perception != "rendered") {
    if (service == "stereo")
      return [&](rover::Node& n) { return make_geometric_stereo(n, config_dir, perception.geometric); };
    if (service == "visual_odometry")
      return [&](rover::Node& n) { return make_geometric_odometry(n, config_dir, perception.geometric); };
    if (service == "point_cloud")
      return [&](rover::Node& n) { return make_geometric_cloud(n, config_dir, perception.geometric); };
  }
  if (arguments.perception == "truth") {
    if (service == "hazard_detector") return [&](rover::Node& n) { return make_truth_hazards(n, perception.truth); };
    if (service == "traversability")
      return [&](rover::Node& n) { return make_truth_traversability(n, perception.truth); };
  }
  return rover::service_factory(service, config_dir);
}

int simulate(const Arguments& arguments) {
  const rover::Scenario scenario = rover::load_scenario(arguments.scenario);
  const auto rover_and_world = rover::make_simulated_rover(scenario, arguments.config_dir, arguments.seed);
  Perception perception(*rover_and_world, rover::ground_appearance(scenario, arguments.seed), arguments.seed,
                        arguments.config_dir);
  lcm::LCM bus("memq://");
  rover::Stack stack(bus, arguments.run_dir, false, rover::load_navigation(arguments.config_dir).cpu_scale);
  rover::SimulatorOptions options;
  options.participants = rover::service_names(arguments.with_full);
  for (const std::string& name : options.participants) stack.add(name, factory(name, arguments, perception));
  rover::InProcess in_process;
  in_process.run_services = [&stack] { return stack.work(); };
  if (arguments.perception != "rendered") {
    in_process.loccam = [&](rover::Utime utime, const Eigen::Isometry3d& T_map_left) {
      perception.geometric.loccam.add(utime, T_map_left);
      perception.geometric.loccam_motion.add(utime, T_map_left);
    };
    in_process.navcam = [&](rover::Utime utime, const Eigen::Isometry3d& T_map_left) {
      perception.geometric.navcam.add(utime, T_map_left);
    };
  }
  rover::Simulator simulator(rover::with_scenario(options, scenario), *rover_and_world, bus, nullptr, in_process);
  stack.start();
  rover::SimulationSummary summary = simulator.run(rover::keep_running);
  stack.work();  // the last tick
  summary.seconds_of_service = stack.seconds_of_service();
  for (const std::string& left : summary.left) std::printf("%s\n", left.c_str());
  rover::write_summary(arguments.run_dir, summary);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Grids and images are allocated at each step: memory that is kept need not be cleared by the kernel again.
  mallopt(M_MMAP_THRESHOLD, 256 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  Arguments arguments;
  CLI::App app("rover_one_process: simulator and services in one process");
  app.add_option("--config", arguments.config_dir, "folder of the configuration")->required();
  app.add_option("--scenario", arguments.scenario, "scenario file")->required();
  app.add_option("--run-dir", arguments.run_dir, "the run's folder")->required();
  app.add_option("--seed", arguments.seed, "seed of everything random")->capture_default_str();
  app.add_option("--perception", arguments.perception)
      ->check(CLI::IsMember({"rendered", "geometric", "truth"}))
      ->capture_default_str();
  app.add_flag("--full", arguments.with_full, "with the services of the Full level");
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  rover::catch_interrupts();
  try {
    return simulate(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rover_one_process: %s\n", error.what());
    return 2;
  }
}
