#include "tools/launcher/run_folder.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <regex>

#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/yaml_file.hpp"
#include "common/geo/elevation_map.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "rover_simulator/world/scenario.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

std::string time_stamp() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", std::localtime(&now));
  return text;
}

// The run's copy needs the absolute path of the elevation model.
void copy_scenario(const std::string& file, const std::string& dtm_file, const fs::path& to) {
  YAML::Node scenario = load_yaml(file);
  if (!dtm_file.empty()) scenario["world"]["dtm"] = fs::absolute(dtm_file).lexically_normal().string();
  write_yaml(to, scenario);
}

// The mission plan: start pose estimate with the height from the orbital map, and path.
void write_ground(const Scenario& scenario, const std::string& level, double start_z_m, const fs::path& file) {
  const Pose2 start = scenario.start_pose();
  YAML::Node ground;
  ground["start"]["x_m"] = start.x_m;
  ground["start"]["y_m"] = start.y_m;
  ground["start"]["z_m"] = start_z_m;
  ground["start"]["yaw_deg"] = to_deg(start.yaw_rad);
  ground["start"]["sigma_m"] = std::max(0.01, scenario.start.sigma_m);
  ground["start"]["sigma_yaw_deg"] = std::max(0.05, to_deg(scenario.start.sigma_yaw_rad));
  ground["start"]["clear_radius_m"] = scenario.start.clear_radius_m;
  ground["path"]["x_m"] = scenario.path.x_m;
  ground["path"]["y_m"] = scenario.path.y_m;
  std::vector<int> levels = scenario.path.level;
  if (level != "auto") std::fill(levels.begin(), levels.end(), level == "full" ? 1 : 0);
  ground["path"]["level"] = levels;
  ground["path"]["corridor_half_width_m"] = scenario.path.corridor_half_width_m;
  ground["path"]["goal_tolerance_m"] = scenario.path.goal_tolerance_m;
  for (const Zone& zone : scenario.zones) {
    YAML::Node out;
    out["name"] = zone.name;
    out["kind"] = zone.keep_in ? "keep_in" : "keep_out";
    for (const Eigen::Vector2d& p : zone.points) out["x_m"].push_back(p.x()), out["y_m"].push_back(p.y());
    ground["zones"].push_back(out);
  }
  write_yaml(file, ground);
}

// Empty unless the path is names separated by dots.
std::vector<std::string> keys_of(const std::string& path) {
  std::vector<std::string> keys(1);
  for (const char c : path) {
    if (c == '.') {
      keys.emplace_back();
    } else if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      keys.back() += c;
    } else {
      return {};
    }
  }
  return std::find(keys.begin(), keys.end(), "") == keys.end() ? keys : std::vector<std::string>{};
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  for (size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + with.size()))
    text.replace(at, old.size(), with);
  return text;
}

double height_at(const ElevationRaster& raster, double x_m, double y_m) {
  const int column = std::clamp(static_cast<int>(x_m / raster.resolution_m), 0, raster.width - 1);
  const int row = std::clamp(static_cast<int>(y_m / raster.resolution_m), 0, raster.height - 1);
  return raster.at(column, row);
}

// By the simulator, which renders: this takes seconds, and needs what the rover's own computer may not have.
void make_orbital_picture(const RunArguments& arguments, const RunFolder& folder) {
  const std::string log = folder.dir + "/service_logs/orbital_picture.log";
  const std::vector<std::string> command = {arguments.bin_dir + "/rover_simulator",
                                            "--scenario",
                                            folder.scenario,
                                            "--seed",
                                            std::to_string(folder.seed),
                                            "--bus",
                                            folder.bus_url,
                                            "--orbital-picture",
                                            folder.dir + "/orbital_picture.tif"};
  if (run_into(log, command) == 0) return;
  std::string line;
  std::getline(std::ifstream(log), line);
  throw ConfigError("the picture from orbit could not be made: " + line);
}

void fill_run_folder(const RunArguments& arguments, const std::string& dtm_file, RunFolder& folder) {
  copy_configuration(arguments.source_dir + "/config", folder.config_dir);
  copy_scenario(arguments.scenario, dtm_file, folder.scenario);
  apply_settings(arguments.headless, arguments.record, arguments.set, folder);

  const Scenario scenario = load_scenario(folder.scenario);
  folder.has_faults = !scenario.faults.empty();
  folder.map_notes = scenario.dtm_notes;
  folder.level = arguments.level.empty() ? scenario.level : arguments.level;
  folder.seed = arguments.seed >= 0 ? arguments.seed : static_cast<std::int64_t>(scenario.seed);
  const World world(scenario.world, scenario.dtm, static_cast<std::uint64_t>(folder.seed));
  const ElevationRaster orbital = world.orbital_map(scenario.orbital_resolution_m);
  write_geotiff(folder.dir + "/orbital_map.tif", orbital);
  if (scenario.orbital_picture && arguments.perception == "rendered") make_orbital_picture(arguments, folder);
  const Pose2 start = scenario.start_pose();
  write_ground(scenario, folder.level, height_at(orbital, start.x_m, start.y_m), folder.config_dir + "/ground.yaml");
}

}  // namespace

void copy_configuration(const std::string& from, const std::string& to) {
  for (const auto& entry : fs::directory_iterator(from))
    if (entry.path().extension() == ".yaml") fs::copy_file(entry.path(), fs::path(to) / entry.path().filename());
}

void apply_setting(const std::string& setting, const std::string& config_dir) {
  const size_t equals = setting.find('=');
  const std::vector<std::string> keys = keys_of(setting.substr(0, equals));
  if (equals == std::string::npos || equals + 1 == setting.size() || keys.size() < 2)
    throw ConfigError("--set " + setting + ": file.key=value is expected, as in path_planner.clearance.min_m=0.12");
  const fs::path file = fs::path(config_dir) / (keys.front() + ".yaml");
  std::error_code ignored;  // name too long
  if (!fs::exists(file, ignored))
    throw ConfigError("--set " + setting + ": there is no config/" + keys.front() + ".yaml");
  const YAML::Node root = load_yaml(file);
  YAML::Node node = root;
  for (size_t i = 1; i + 1 < keys.size(); ++i) {
    const YAML::Node child = node[keys[i]];
    if (!child.IsDefined() || !child.IsMap())
      throw ConfigError("--set " + setting + ": no section '" + keys[i] + "' in " + file.filename().string());
    node.reset(child);
  }
  node[keys.back()] = parse_yaml(setting.substr(equals + 1), "--set " + setting.substr(0, equals));
  write_yaml(file, root);
}

void apply_settings(bool headless, const std::string& record, const std::vector<std::string>& set, RunFolder& folder) {
  if (headless) apply_setting("mission_control.page=false", folder.config_dir);
  if (!record.empty()) apply_setting("recorder.record=" + record, folder.config_dir);
  for (const std::string& setting : set) {
    apply_setting(setting, folder.config_dir);
    folder.set_files.push_back(setting.substr(0, setting.find('.')) + ".yaml");
  }
  if (!folder.bus_url.empty()) apply_setting("bus.url=" + folder.bus_url, folder.config_dir);
  folder.bus_url = Config::load(folder.config_dir + "/bus.yaml").text("url");
}

RunFolder create_folders(const std::string& source_dir, const std::string& out, const std::string& name) {
  const fs::path wanted =
      fs::absolute(out.empty() ? fs::path(source_dir) / "logs" / (time_stamp() + "-" + name) : fs::path(out));
  fs::path dir = wanted;
  try {
    fs::create_directories(wanted.parent_path());
    bool is_new = fs::create_directory(dir);
    for (int number = 2; out.empty() && !is_new; ++number) {
      dir = wanted.string() + "-" + std::to_string(number);
      is_new = fs::create_directory(dir);
    }
    // The second condition is that of another run that takes the same empty folder.
    if ((!is_new && !fs::is_empty(dir)) || !fs::create_directory(dir / "config"))
      throw ConfigError(dir.string() + ": already exists and is not empty");
    fs::create_directory(dir / "service_logs");
    return {.dir = dir, .config_dir = dir / "config", .scenario = dir / "config" / "scenario.yaml", .is_new = is_new};
  } catch (const fs::filesystem_error& error) {
    throw ConfigError(dir.string() + ": cannot be created: " + error.code().message());
  }
}

RunFolder make_run_folder(const RunArguments& arguments) {
  if (const std::string problem = file_problem(arguments.scenario); !problem.empty())
    throw ConfigError(arguments.scenario + ": " + problem);
  // Checked first, so that errors name the user's own file.
  const std::string dtm_file = load_scenario(arguments.scenario).dtm_file;
  RunFolder folder = create_folders(arguments.source_dir, arguments.out, scenario_name(arguments.scenario));
  folder.bus_url = arguments.bus;
  try {
    fill_run_folder(arguments, dtm_file, folder);
  } catch (const std::exception& error) {
    remove_run_folder(folder);
    const std::string message = replaced(without_lines(error.what(), folder), folder.scenario, arguments.scenario);
    throw ConfigError(in_users_files(message, folder, arguments.source_dir + "/config"));
  }
  return folder;
}

RunFolder make_replay_folder(const RunArguments& arguments, const std::string& name, const std::string& config_from,
                             const std::string& log_dir) {
  RunFolder folder = create_folders(arguments.source_dir, arguments.out, "replay-" + name);
  folder.bus_url = arguments.bus;
  try {
    copy_configuration(config_from, folder.config_dir);
    for (const char* product : {"orbital_map.tif", "orbital_picture.tif"})
      if (const fs::path file = fs::path(log_dir) / product; fs::exists(file))
        fs::copy(file, fs::path(folder.dir) / product, fs::copy_options::copy_symlinks);
    apply_settings(arguments.headless, arguments.record, arguments.set, folder);
  } catch (const std::exception& error) {
    remove_run_folder(folder);
    throw ConfigError(in_users_files(error.what(), folder, config_from));
  }
  return folder;
}

std::string without_lines(std::string message, const RunFolder& folder) {
  for (const std::string& name : folder.set_files)
    message = std::regex_replace(message, std::regex("/" + name + ":[0-9]+:"), "/" + name + " with --set:");
  return message;
}

std::string in_users_files(const std::string& message, const RunFolder& folder, const std::string& users_config_dir) {
  return replaced(without_lines(message, folder), folder.config_dir,
                  fs::path(users_config_dir).lexically_normal().string());
}

void remove_run_folder(const RunFolder& folder) {
  std::error_code ignored;
  if (folder.is_new) {
    fs::remove_all(folder.dir, ignored);
    return;
  }
  for (const auto& entry : fs::directory_iterator(folder.dir, ignored)) fs::remove_all(entry.path(), ignored);
}

}  // namespace rover
