#include "tools/report/run_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::report {
namespace {

namespace fs = std::filesystem;

template <class T>
void read_optional(const nlohmann::json& from, const char* key, T& value) {
  if (const auto it = from.find(key); it != from.end() && !it->is_null()) value = it->get<T>();
}
template <class T>
void read_optional(const nlohmann::json& from, const char* key, std::optional<T>& value) {
  if (const auto it = from.find(key); it != from.end() && !it->is_null()) value = it->get<T>();
}

nlohmann::json read_json(const std::string& path) {
  if (!fs::exists(path)) return nlohmann::json::object();
  try {
    return nlohmann::json::parse(read_file(path));
  } catch (const nlohmann::json::exception& error) {
    throw ConfigError(path + ": " + error.what());
  }
}

// Run data from run.json (launcher) and simulation.json (simulator); the latter has priority.
RunInfo read_info(const std::string& dir) {
  RunInfo info;
  for (const char* name : {"/run.json", "/simulation.json"}) {
    const nlohmann::json run = read_json(dir + name);
    try {
      read_optional(run, "scenario", info.scenario);
      read_optional(run, "seed", info.seed);
      read_optional(run, "commit", info.commit);
      read_optional(run, "level", info.level);
      read_optional(run, "perception", info.perception);
      read_optional(run, "deterministic", info.deterministic);
      read_optional(run, "realtime", info.realtime);
      read_optional(run, "wall_s", info.wall_s);
      read_optional(run, "simulated_s", info.sim_s);
      read_optional(run, "outcome", info.outcome_hint);
      read_optional(run, "services", info.restarts);
      if (const auto set = run.find("data_set"); set != run.end()) read_optional(*set, "pairs", info.data_set_pairs);
    } catch (const nlohmann::json::exception& error) {
      throw ConfigError(dir + name + ": " + error.what());
    }
  }
  return info;
}

// The first of these names that exists in the folder.
std::string first_existing(const std::string& dir, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (fs::is_regular_file(dir + "/" + name)) return dir + "/" + name;
  return {};
}

Footprint footprint_of(const Vehicle& vehicle) {
  VehicleWheels wheels{vehicle.wheel_radius_m, vehicle.wheel_width_m, {}};
  for (size_t i = 0; i < wheels.p_body.size(); ++i) wheels.p_body[i] = {vehicle.wheel_x_m[i], vehicle.wheel_y_m[i]};
  return {vehicle.footprint_half_length_m(), vehicle.footprint_half_width_m(), vehicle.origin_height_m,
          vehicle.top_speed_mps, wheels};
}

// Positions of the cameras along the body. A recording without cameras.yaml keeps the defaults.
void read_cameras(const std::string& config_dir, Footprint& footprint) {
  const std::string file = config_dir + "/cameras.yaml";
  if (!fs::is_regular_file(file)) return;
  const Config cameras = Config::load(file);
  if (cameras.has("loccam")) footprint.loccam_x_m = read_stereo_rig(cameras, "loccam").T_body_left.translation().x();
  if (cameras.has("navcam")) footprint.navcam_x_m = read_stereo_rig(cameras, "navcam").T_body_left.translation().x();
}

}  // namespace

RunFolder open_run_folder(const std::string& dir, const std::string& default_config_dir) {
  if (const std::string problem = folder_problem(dir); !problem.empty()) throw ConfigError(dir + ": " + problem);
  RunFolder folder;
  folder.dir = dir;
  folder.log = log_file(dir);
  folder.info = read_info(dir);
  folder.scenario = first_existing(dir, {"config/scenario.yaml", "scenario.yaml"});
  folder.orbital_map = first_existing(dir, {"orbital_map.tif", "config/orbital_map.tif"});
  folder.config_dir = fs::is_directory(dir + "/config") ? dir + "/config" : dir;
  if (folder.info.scenario.empty()) folder.info.scenario = fs::path(dir).filename().string();
  const bool has_vehicle = fs::is_regular_file(folder.config_dir + "/vehicle.yaml");
  folder.vehicle = load_vehicle(has_vehicle ? folder.config_dir : default_config_dir);
  folder.footprint = footprint_of(folder.vehicle);
  read_cameras(has_vehicle ? folder.config_dir : default_config_dir, folder.footprint);
  return folder;
}

std::vector<std::pair<std::string, std::string>> configuration_texts(const RunFolder& folder) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& entry : fs::directory_iterator(folder.config_dir))
    if (entry.is_regular_file() && entry.path().extension() == ".yaml")
      texts.emplace_back(entry.path().filename().string(), read_file(entry.path().string()));
  // The scenario first, the rest by name.
  std::sort(texts.begin(), texts.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first != "scenario.yaml", a.first) < std::pair(b.first != "scenario.yaml", b.first);
  });
  return texts;
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ConfigError(path + ": cannot be read");
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

void write_file(const std::string& path, const std::string& content) {
  // Write to a temporary file first, so that an interruption keeps the old one.
  const std::string fresh = path + ".new";
  std::ofstream file(fresh, std::ios::binary | std::ios::trunc);
  file << content;
  file.close();
  std::error_code error;
  if (file) fs::rename(fresh, path, error);
  if (file && !error) return;
  fs::remove(fresh, error);
  throw ConfigError(path + ": cannot be written");
}

}  // namespace rover::report
