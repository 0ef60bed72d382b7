#include "tools/report/bench_rows.hpp"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "common/bus/config.hpp"

namespace rover::report {
namespace {

double number_at(const nlohmann::json& row, const char* key) {
  const auto it = row.find(key);
  return it != row.end() && it->is_number() ? it->get<double>() : kNaN;
}

std::string text_at(const nlohmann::json& row, const char* key) {
  const auto it = row.find(key);
  return it != row.end() && it->is_string() ? it->get<std::string>() : std::string();
}

BenchRow row_from(const nlohmann::json& row) {
  BenchRow out;
  out.commit = text_at(row, "commit");
  out.command = text_at(row, "command");
  out.level = text_at(row, "level");
  out.scenario = row.at("scenario").get<std::string>();
  out.seed = row.at("seed").get<std::int64_t>();
  out.deterministic = row.contains("deterministic") && row["deterministic"] == true;
  out.outcome = text_at(row, "outcome");
  out.planned_length_m = number_at(row, "planned_length_m");
  out.driven_length_m = number_at(row, "driven_length_m");
  out.path_ratio = number_at(row, "path_ratio");
  out.oracle_m = number_at(row, "oracle_m");
  out.regret = number_at(row, "regret");
  if (const auto feasible = row.find("oracle_feasible"); feasible != row.end() && feasible->is_boolean())
    out.oracle_feasible = feasible->get<bool>();
  out.progress = number_at(row, "progress");
  out.replans = number_at(row, "replans");
  out.hazard_stops = number_at(row, "hazard_stops");
  out.collisions = number_at(row, "collisions");
  out.rocks_missed = number_at(row, "rocks_missed");
  out.rocks_encountered = number_at(row, "rocks_encountered");
  out.false_stops = number_at(row, "false_stops");
  if (const auto faults = row.find("fdir"); faults != row.end() && faults->is_array())
    out.faults = static_cast<double>(faults->size());
  out.odometry_drift_percent = number_at(row, "odometry_drift_percent");
  out.cross_track_rms_m = number_at(row, "cross_track_rms_m");
  out.final_error_m = number_at(row, "final_error_m");
  out.mean_speed_m_per_h = number_at(row, "mean_speed_m_per_h");
  out.duty = number_at(row, "duty");
  out.realtime_factor = number_at(row, "realtime_factor");
  out.duration_s = number_at(row, "duration_s");
  out.reverse_m = number_at(row, "reverse_m");
  out.hazard_clearance_m = number_at(row, "hazard_clearance_m");
  if (const auto seconds = row.find("seconds"); seconds != row.end() && seconds->is_object())
    out.seconds = seconds->get<std::map<std::string, double>>();
  if (const auto anees = row.find("anees"); anees != row.end() && anees->is_object()) {
    out.anees_x = number_at(*anees, "x");
    out.anees_y = number_at(*anees, "y");
    out.anees_yaw = number_at(*anees, "yaw");
    out.anees_xyyaw = number_at(*anees, "xyyaw");
  }
  return out;
}

}  // namespace

std::vector<BenchRow> parse_rows(const std::string& text_at, const std::string& file) {
  std::vector<BenchRow> rows;
  std::istringstream in(text_at);
  int number_of_line = 0;
  for (std::string line; std::getline(in, line);) {
    ++number_of_line;
    if (line.empty()) continue;
    try {
      rows.push_back(row_from(nlohmann::json::parse(line)));
    } catch (const nlohmann::json::exception& error) {
      throw ConfigError(file + ":" + std::to_string(number_of_line) + ": " + error.what());
    }
  }
  return rows;
}

BenchContext this_machine() {
  BenchContext context;
  context.cpu_model = "unknown";
  context.cores = static_cast<int>(std::thread::hardware_concurrency());
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) {
      context.cpu_model = line.substr(line.find(':') + 2);
      break;
    }
  return context;
}

}  // namespace rover::report
