#include "mission_control/config.hpp"

#include <sys/stat.h>

#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/path_limits.hpp"

namespace rover {
namespace {

constexpr Range kMap{-1e7, 1e7};

StartPose read_start(const Config& config) {
  StartPose start;
  start.pose.x_m = config.number("x_m", kMap);
  start.pose.y_m = config.number("y_m", kMap);
  start.z_m = config.number("z_m", {-1e5, 1e5});
  start.pose.yaw_rad = to_rad(config.number("yaw_deg", {-360, 360}));
  config.read("sigma_m", start.sigma_m, {1e-4, 100});
  config.read_deg("sigma_yaw_deg", start.sigma_yaw_rad, {1e-3, 180});
  config.read("clear_radius_m", start.clear_radius_m, {0, 10});
  return start;
}

GlobalPath read_path(const Config& config) {
  GlobalPath path;
  path.x_m = config.numbers("x_m", kMap, 0);
  path.y_m = config.numbers("y_m", kMap, path.x_m.size());
  if (const std::string problem = path_length_problem(path_length_m(path.x_m, path.y_m)); !problem.empty())
    config.fail("x_m", problem);
  for (double level : config.numbers("level", {0, 1}, path.x_m.size()))
    path.level.push_back(static_cast<std::int8_t>(level));
  config.read("corridor_half_width_m", path.corridor_half_width_m, {0.1, 50});
  config.read("goal_tolerance_m", path.goal_tolerance_m, {0.01, 10});
  return path;
}

// Rows of the fault table shown as gauges, with the lower limit that warns first.
struct Gauge {
  const char* name;
  const char* row;
  const char* warning_row;
};
constexpr std::array kGauges = {Gauge{"slip", "slip", "slip_high"}, Gauge{"roll_deg", "roll", "roll_high"},
                                Gauge{"pitch_deg", "pitch", "pitch_high"}, Gauge{"current_a", "drive_current", ""}};

nlohmann::json gauge_limits(const std::string& config_dir, const Vehicle& vehicle) {
  std::map<std::string, double> limit;
  for (const Config& row : Config::load(config_dir + "/fdir.yaml").list("rows"))
    limit[row.text("id")] = row.number("limit", {-1e9, 1e9});
  nlohmann::json out;
  for (const Gauge& gauge : kGauges) {
    const auto value = [&](const char* row) { return limit.contains(row) ? nlohmann::json(limit[row]) : nullptr; };
    out[gauge.name] = {{"limit", value(gauge.row)}, {"warn", value(gauge.warning_row)}};
  }
  out["current_a"]["warn"] = vehicle.drive_current_nominal_a;
  return out;
}

// Pan axis position and half field of view of the NavCam; null if the vehicle has none.
nlohmann::json navcam_view(const std::string& config_dir, const Vehicle& vehicle) {
  if (!vehicle.pan_tilt) return nullptr;
  const StereoRig rig = load_stereo_rig(config_dir, "navcam");
  const Eigen::Vector3d& axes = vehicle.pan_tilt->p_body_axes;
  return {{"x_m", axes.x()}, {"y_m", axes.y()}, {"half_width", std::atan(0.5 * rig.width / rig.left.fx_px)}};
}

}  // namespace

MissionPlan load_mission_plan(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/ground.yaml");
  const MissionPlan plan{read_start(config.section("start")), read_path(config.section("path"))};
  config.finish();
  return plan;
}

namespace mission {
namespace {

OperatorPathConfig read_drawn_path(const Config& config) {
  OperatorPathConfig path;
  config.read("corridor_half_width_m", path.corridor_half_width_m, {0.1, 50});
  config.read("goal_tolerance_m", path.goal_tolerance_m, {0.01, 10});
  config.read("longest_m", path.max_length_m, {1, 1e5});
  config.read_deg("warn_slope_deg", path.slope.warn_rad, {0, 90});
  config.read_deg("most_slope_deg", path.slope.max_rad, {0, 90});
  if (path.slope.max_rad < path.slope.warn_rad) config.fail("most_slope_deg", "is below warn_slope_deg");
  return path;
}

}  // namespace

PageConfig load_page_config(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/mission_control.yaml");
  PageConfig page;
  std::string token_file;
  config.read("page", page.served);
  config.read("address", page.guard.address);
  config.read("port", page.guard.port, {1, 65535});
  config.read("most_pages", page.max_pages, {1, 64});
  config.read("token_file", token_file);
  page.path = read_drawn_path(config.section("path"));
  config.finish();
  if (!page.served) return page;
  if (!token_file.empty())
    page.guard.token = load_token(token_file);
  else if (!is_loopback(page.guard.address))
    config.fail("address", page.guard.address +
                               " can be reached from elsewhere: token_file has to name a file of mode "
                               "0600 with a token in it");
  return page;
}

std::string load_token(const std::string& file) {
  constexpr size_t kShortest = 16;
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) throw ConfigError(file + ": cannot be read");
  if ((status.st_mode & 0777) != 0600)
    throw ConfigError(file + ": others may read the token. Mend it with: chmod 600 " + file);
  std::ifstream in(file);
  std::string token;
  in >> token;
  if (token.size() < kShortest)
    throw ConfigError(file + ": a token of at least 16 characters is expected. Make one with: openssl rand -hex 16");
  if (token.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") != std::string::npos)
    throw ConfigError(file + ": a token holds letters, digits, - and _ alone");
  return token;
}

nlohmann::json page_setup(const std::string& config_dir, const Vehicle& vehicle) {
  const Config coverage = Config::load(config_dir + "/hazard_detector.yaml").section("coverage");
  return {{"vehicle",
           {{"half_length_m", vehicle.body_half_length_m},
            {"half_width_m", vehicle.body_half_width_m},
            {"origin_height_m", vehicle.origin_height_m},
            {"wheel_x_m", vehicle.wheel_x_m},
            {"wheel_y_m", vehicle.wheel_y_m},
            {"wheel_radius_m", vehicle.wheel_radius_m},
            {"wheel_width_m", vehicle.wheel_width_m},
            {"steered", kSteeredWheels},
            {"top_speed_mps", vehicle.top_speed_mps}}},
          {"gauges", gauge_limits(config_dir, vehicle)},
          {"navcam", navcam_view(config_dir, vehicle)},
          {"roi",
           {{"near_m", coverage.number("roi_near_m", {0, 100})}, {"far_m", coverage.number("roi_far_m", {0, 100})}}}};
}

}  // namespace mission
}  // namespace rover
