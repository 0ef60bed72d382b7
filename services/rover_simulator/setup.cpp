#include "rover_simulator/setup.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "rover_simulator/orbital_picture.hpp"

namespace rover {
namespace {

StereoRig load_rig(const std::string& config_dir, const std::string& camera) {
  const StereoRig rig = load_stereo_rig(config_dir, camera);
  const std::string problem = problem_of_rendering(rig);
  if (!problem.empty()) throw ConfigError(config_dir + "/cameras.yaml: " + camera + ": " + problem);
  return rig;
}

}  // namespace

GroundAppearanceConfig ground_appearance(const Scenario& scenario, std::uint64_t seed) {
  GroundAppearanceConfig appearance;
  appearance.sun_elevation_rad = scenario.sun_elevation_rad;
  appearance.sun_azimuth_rad = scenario.sun_azimuth_rad;
  appearance.seed = seed;
  return appearance;
}

std::unique_ptr<SimulatedRover> make_simulated_rover(const Scenario& scenario, const std::string& config_dir,
                                                     std::uint64_t seed) {
  const Vehicle vehicle = load_vehicle(config_dir);
  const StereoRig loccam = load_rig(config_dir, "loccam");
  SimulatedRoverConfig config;
  config.vehicle.gravity_mps2 = scenario.gravity_mps2;
  config.loccam.calibration_error_px = scenario.calibration_error_px;
  config.mounting_error_rad = scenario.mounting_error_rad;
  config.loccam.scene.appearance = ground_appearance(scenario, seed);
  config.start_sigma_m = scenario.start.sigma_m;
  config.start_sigma_yaw_rad = scenario.start.sigma_yaw_rad;
  if (vehicle.pan_tilt) config.navcam = load_rig(config_dir, "navcam");
  return std::make_unique<SimulatedRover>(config, vehicle, loccam,
                                          std::make_unique<World>(scenario.world, scenario.dtm, seed),
                                          scenario.start_pose(), seed);
}

void write_orbital_picture(const Scenario& scenario, std::uint64_t seed, const std::string& file) {
  const World world(scenario.world, scenario.dtm, seed);
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  write_geotiff(file, orbital_picture(world, scenario.orbital_picture.value_or(OrbitalPictureConfig{}),
                                      ground_appearance(scenario, seed), threads));
}

SimulatorOptions with_scenario(SimulatorOptions options, const Scenario& scenario) {
  options.end.timeout_s = scenario.timeout_s;
  options.faults = scenario.faults;
  return options;
}

void write_summary(const std::string& run_dir, const SimulationSummary& summary) {
  const nlohmann::json json = {{"outcome", summary.outcome},
                               {"deterministic", summary.deterministic},
                               {"simulated_s", summary.simulated_s},
                               {"wall_s", summary.wall_s},
                               {"left", summary.left},
                               {"seconds_of_service", summary.seconds_of_service}};
  std::ofstream(run_dir + "/simulation.json.new") << json.dump(2) << "\n";
  std::filesystem::rename(run_dir + "/simulation.json.new", run_dir + "/simulation.json");
}

}  // namespace rover
