#include "mission_control/config.hpp"

#include <sys/stat.h>

#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/navigation_config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/bus/zone_list.hpp"
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
  config.read("clear_radius_m", start.clear_radius_m, {0, 5});
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
  MissionPlan plan{read_start(config.section("start")), read_path(config.section("path"))};
  plan.path.zones = read_zones(config);
  config.finish();
  return plan;
}

namespace mission {
namespace {

void share(const NavigationConfig& navigation, OperatorPathConfig& path) {
  path.corridor_half_width_m = navigation.corridor_half_width_m;
  path.goal_tolerance_m = navigation.goal_tolerance_m;
  path.slope = {navigation.steep_slope_rad, navigation.max_slope_rad};
}

}  // namespace

PageConfig load_config(const std::string& config_dir, ParameterList* list) {
  PageConfig page;
  std::string token_file;
  Parameters p(config_dir + "/mission_control.yaml", "Ground station and its web page, http://ADDRESS:PORT.", list);
  if (list == nullptr) share(load_navigation(config_dir), page.path);
  p.add("page", page.served, "false: only the commands of the mission plan (./rover run --headless)");
  p.add("address", page.guard.address, "any other address than the loopback requires token_file");
  p.add("port", page.guard.port, {1, 65535}, "TCP port");
  p.add("token_file", token_file,
        "file of mode 0600 with at least 16 characters; open the page once as /?token=... to log in");
  p.add("max_pages", page.max_pages, {1, 64}, "pages open at the same time");
  p.section("path", "drawn or loaded by the operator")
      .add("max_length_m", page.path.max_length_m, {1, 1e5}, "longer paths are refused");
  p.finish();
  if (!page.served) return page;
  if (!token_file.empty()) page.guard.token = load_token(token_file);
  p.check(!page.guard.token.empty() || is_loopback(page.guard.address), "address",
          page.guard.address + " is reachable from other machines: token_file must name a file of mode 0600 that " +
              "contains a token");
  return page;
}

std::string load_token(const std::string& file) {
  constexpr size_t kMinLength = 16;
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) throw ConfigError(file + ": cannot be read");
  if ((status.st_mode & 0777) != 0600)
    throw ConfigError(file + ": the token is readable by others. Fix: chmod 600 " + file);
  std::ifstream in(file);
  std::string token;
  in >> token;
  if (token.size() < kMinLength)
    throw ConfigError(file + ": a token of at least 16 characters is required. Create one: openssl rand -hex 16");
  if (token.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") != std::string::npos)
    throw ConfigError(file + ": a token may contain only letters, digits, - and _");
  return token;
}

nlohmann::json page_setup(const std::string& config_dir, const Vehicle& vehicle) {
  const NavigationConfig navigation = load_navigation(config_dir);
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
          {"roi", {{"near_m", navigation.hazard_roi_near_m}, {"far_m", navigation.hazard_roi_far_m}}}};
}

}  // namespace mission
}  // namespace rover
