#include "rover_simulator/world/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/zone_list.hpp"
#include "common/core/path_limits.hpp"
#include "common/geo/elevation_map.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

constexpr Range kMap{-1e7, 1e7};
constexpr double kSamePointM = 1e-3;
constexpr double kMaxPictureAreaM2 = 500'000.0;  // all of it is in the memory
constexpr double kGoalClearRadiusM = 1.0;
// A rover whose start is known as well as this stands within the circle about it, with room to spare.
constexpr double kWellKnownStartM = 0.1;
constexpr double kClearHeightM = 0.12;  // maximum rock height in a certified circle, below hazard size

std::string find_dtm(const Config& world, const std::string& file) {
  const std::string name = world.text("dtm");
  const std::string found = user_path(name.starts_with("~") ? fs::path(name) : fs::path(file).parent_path() / name);
  if (!fs::is_regular_file(found)) world.fail("dtm", "elevation model " + found + " not found");
  return found;
}

ElevationRaster read_plane(const Config& plane) {
  double slope_rad = 0.0, toward_rad = 0.0;
  plane.read_deg("slope_deg", slope_rad, {0, 35});
  plane.read_deg("toward_deg", toward_rad, {-360, 360});
  return plane_raster(plane.number("width_m", {8, 2000}), plane.number("height_m", {8, 2000}), 1.0, slope_rad,
                      toward_rad);
}

void read_soil(const Config& soil, SoilConfig& config) {
  if (soil.has("everywhere")) {
    const std::string name = soil.one_of("everywhere", {"sand", "firm", "bedrock"});
    config.everywhere = name == "sand" ? Soil::kSand : name == "firm" ? Soil::kFirm : Soil::kBedrock;
  }
  soil.read("patch_m", config.patch_m, {1, 500});
  soil.read("sand_fraction", config.sand_fraction, {0, 1});
  soil.read("bedrock_fraction", config.bedrock_fraction, {0, 1});
}

void read_orbital(const Config& orbital, Scenario& scenario) {
  OrbitalConfig& config = scenario.world.orbital;
  orbital.read("resolution_m", scenario.orbital_resolution_m, {0.25, 10});
  orbital.read("smoothing_px", config.smoothing_px, {0, 5});
  orbital.read("vertical_noise_m", config.vertical_noise_m, {0, 5});
  orbital.read("distortion_m", config.distortion_m, {0, 10});
}

OrbitalPictureConfig read_orbital_picture(const Config& yaml) {
  OrbitalPictureConfig config;
  yaml.read("resolution_m", config.resolution_m, {0.1, 5});
  yaml.read_deg("sun_elevation_deg", config.sun_elevation_rad, {5, 90});
  yaml.read_deg("sun_azimuth_deg", config.sun_azimuth_rad, {-360, 360});
  yaml.read("noise", config.noise, {0, 1});
  return config;
}

std::vector<RockZone> read_rock_zones(const Config& world) {
  std::vector<RockZone> zones;
  for (const Config& yaml : world.list("rock_zones")) {
    RockZone zone;
    zone.k = yaml.number("rock_area_k", {0, 0.4});
    zone.half_width_m = yaml.number("half_width_m", {0.5, 1000});
    zone.x_m = yaml.numbers("x_m", kMap, 0);
    zone.y_m = yaml.numbers("y_m", kMap, zone.x_m.size());
    if (zone.x_m.empty()) yaml.fail("x_m", "a zone requires at least one point");
    zones.push_back(std::move(zone));
  }
  return zones;
}

void read_world(const Config& world, const std::string& file, Scenario& scenario) {
  if (world.has("plane")) {
    scenario.dtm = read_plane(world.section("plane"));
  } else {
    scenario.dtm_file = find_dtm(world, file);
    ElevationMap map = read_elevation_map(scenario.dtm_file);
    require_no_voids(map, scenario.dtm_file);
    scenario.dtm = std::move(map.raster);
    scenario.dtm_notes = std::move(map.notes);
  }
  world.read("rock_area_k", scenario.world.rocks.k, {0, 0.4});
  if (world.has("rock_zones")) scenario.world.rocks.zones = read_rock_zones(world);
  world.read("rock_max_diameter_m", scenario.world.rocks.max_diameter_m, {0.1, 5});
  world.read("roughness_rms_m", scenario.world.roughness.rms_m, {0, 0.1});
  if (world.has("soil")) read_soil(world.section("soil"), scenario.world.soil);
  if (world.has("orbital_map")) read_orbital(world.section("orbital_map"), scenario);
  if (world.has("orbital_picture")) {
    scenario.orbital_picture = read_orbital_picture(world.section("orbital_picture"));
    if (scenario.dtm.width_m() * scenario.dtm.height_m() > kMaxPictureAreaM2)
      world.fail("orbital_picture", "the world is too large for it: at most 500000 m2 are rendered");
  }
  world.read("gravity_mps2", scenario.gravity_mps2, {0.5, 20});
}

void check_inside(const Config& config, const ElevationRaster& dtm, double x_m, double y_m, size_t index) {
  if (x_m >= 0.0 && y_m >= 0.0 && x_m <= dtm.width_m() && y_m <= dtm.height_m()) return;
  const std::string size =
      std::to_string(std::lround(dtm.width_m())) + " x " + std::to_string(std::lround(dtm.height_m())) + " m";
  config.fail("x_m", "point " + std::to_string(index + 1) + " lies outside of the elevation model (" + size + ")");
}

PlannedPath read_path(const Config& config, const ElevationRaster& dtm) {
  PlannedPath path;
  path.x_m = config.numbers("x_m", kMap, 0);
  path.y_m = config.numbers("y_m", kMap, path.x_m.size());
  if (path.x_m.size() < 2) config.fail("x_m", "a path requires at least two points");
  path.level.assign(path.x_m.size(), 0);
  if (config.has("level")) {
    const std::vector<double> levels = config.numbers("level", {0, 1}, path.x_m.size());
    std::transform(levels.begin(), levels.end(), path.level.begin(), [](double level) { return level > 0.5 ? 1 : 0; });
  }
  for (size_t i = 0; i < path.x_m.size(); ++i) {
    check_inside(config, dtm, path.x_m[i], path.y_m[i], i);
    if (i > 0 && std::hypot(path.x_m[i] - path.x_m[i - 1], path.y_m[i] - path.y_m[i - 1]) < kSamePointM)
      config.fail("x_m", "points " + std::to_string(i) + " and " + std::to_string(i + 1) + " are the same");
  }
  if (const std::string problem = path_length_problem(path_length_m(path.x_m, path.y_m)); !problem.empty())
    config.fail("x_m", problem);
  config.read("corridor_half_width_m", path.corridor_half_width_m, {0.5, 20});
  config.read("goal_tolerance_m", path.goal_tolerance_m, {0.05, 5});
  return path;
}

PlannedStart read_start(const Config& config) {
  PlannedStart start;
  if (config.has("yaw_deg")) start.yaw_rad = to_rad(config.number("yaw_deg", {-360, 360}));
  config.read("clear_radius_m", start.clear_radius_m, {0, 5});
  config.read("sigma_m", start.sigma_m, {0, 5});
  config.read_deg("sigma_yaw_deg", start.sigma_yaw_rad, {0, 30});
  return start;
}

void read_sun(const Config& sun, Scenario& scenario) {
  sun.read_deg("elevation_deg", scenario.sun_elevation_rad, {5, 90});
  sun.read_deg("azimuth_deg", scenario.sun_azimuth_rad, {-360, 360});
}

std::vector<KeepClear> certified_circles(const Scenario& scenario) {
  const PlannedPath& path = scenario.path;
  const PlannedStart& start = scenario.start;
  const double sigma_m = start.sigma_m > kWellKnownStartM ? start.sigma_m : 0.0;
  return {{path.x_m.front(), path.y_m.front(), start.clear_radius_m, kClearHeightM, sigma_m},
          {path.x_m.back(), path.y_m.back(), kGoalClearRadiusM, kClearHeightM}};
}

}  // namespace

Pose2 Scenario::start_pose() const {
  const double along = std::atan2(path.y_m[1] - path.y_m[0], path.x_m[1] - path.x_m[0]);
  return {path.x_m[0], path.y_m[0], start.yaw_rad.value_or(along)};
}

double Scenario::path_length_m() const {
  return rover::path_length_m(path.x_m, path.y_m);
}

Scenario load_scenario(const std::string& file) {
  const Config config = Config::load(file);
  Scenario scenario;
  scenario.name = fs::path(file).stem().string();
  if (config.has("seed")) scenario.seed = static_cast<std::uint64_t>(config.integer64("seed", {0, 9e15}));
  read_world(config.section("world"), file, scenario);
  if (config.has("level")) scenario.level = config.one_of("level", {"efficient", "auto", "full"});
  scenario.path = read_path(config.section("path"), scenario.dtm);
  scenario.zones = read_zones(config);
  if (config.has("start")) scenario.start = read_start(config.section("start"));
  if (config.has("sun")) read_sun(config.section("sun"), scenario);
  config.read("calibration_error_px", scenario.calibration_error_px, {0, 5});
  config.read_deg("mounting_error_deg", scenario.mounting_error_rad, {0, 2});
  config.read("timeout_s", scenario.timeout_s, {10, 1e6});
  scenario.faults = read_faults(config);
  config.finish();
  scenario.world.keep_clear = certified_circles(scenario);
  return scenario;
}

}  // namespace rover
