// rover_oracle SCENARIO --seeds A..B: one JSON line per seed.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/bus/command_line.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/vehicle_config.hpp"
#include "rover_simulator/world/rover_streams.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "tools/launcher/arguments.hpp"
#include "tools/oracle/oracle.hpp"

namespace {

void print_seed(const rover::Scenario& scenario, std::uint64_t seed, rover::oracle::Request& request) {
  const auto begin = std::chrono::steady_clock::now();
  const std::array<double, 3> error = rover::start_error(seed);
  const rover::Pose2 told = scenario.start_pose();
  request.start = {told.x_m + scenario.start.sigma_m * error[0], told.y_m + scenario.start.sigma_m * error[1],
                   told.yaw_rad + scenario.start.sigma_yaw_rad * error[2]};
  const rover::World world(scenario.world, scenario.dtm, seed);
  request.height_m = [&world](double x_m, double y_m) { return world.height_m(x_m, y_m); };
  request.ground_m = [&world](double x_m, double y_m) { return world.ground_height_m(x_m, y_m); };
  const rover::oracle::Result result = rover::oracle::shortest_path(request);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  nlohmann::ordered_json line{{"scenario", scenario.name}, {"seed", seed}};
  const bool known = result.status != rover::oracle::Status::kGaveUp;
  line["feasible"] = known ? nlohmann::json(result.status == rover::oracle::Status::kFound) : nlohmann::json(nullptr);
  line["reason"] = status_text(result.status);
  line["oracle_m"] = std::isfinite(result.length_m) ? nlohmann::json(result.length_m) : nlohmann::json(nullptr);
  line["planned_m"] = scenario.path_length_m();
  line["seconds"] = seconds;
  line["expansions"] = result.expansions;
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  std::string config_dir = rover::project_dir() + "/config";
  std::string seeds;
  CLI::App app("Shortest drivable path of a scenario on the true ground, one JSON line per seed.");
  app.name("rover_oracle");
  app.add_option("scenario", file, "scenario file")->required()->transform(rover::is_user_path());
  app.add_option("--config", config_dir, "folder of vehicle.yaml")->transform(rover::is_user_path());
  app.add_option("--seeds", seeds, "first..last; default: the scenario's own");
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  try {
    const rover::Scenario scenario = rover::load_scenario(file);
    rover::oracle::Request request{.map_width_m = scenario.dtm.width_m(),
                                   .map_length_m = scenario.dtm.height_m(),
                                   .vehicle = rover::load_vehicle(config_dir),
                                   .goal_tolerance_m = scenario.path.goal_tolerance_m,
                                   .corridor_half_width_m = scenario.path.corridor_half_width_m,
                                   .zones = scenario.zones};
    for (size_t i = 0; i < scenario.path.x_m.size(); ++i)
      request.planned.emplace_back(scenario.path.x_m[i], scenario.path.y_m[i]);
    const auto own = std::to_string(scenario.seed);
    for (const std::int64_t seed : rover::parse_seeds(seeds.empty() ? own : seeds))
      print_seed(scenario, static_cast<std::uint64_t>(seed), request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
