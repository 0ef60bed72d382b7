#include "tools/campaign/row.hpp"

#include <cmath>
#include <set>

#include "common/bus/config.hpp"
#include "common/core/decimal.hpp"

namespace rover::campaign {
namespace {

using Json = nlohmann::json;

// Members of every row; metrics of the same name are left out.
const std::set<std::string> kKeys = {"commit", "cell", "seed", "attempts", "status", "outcome"};
// Processor time, memory and wall time differ from machine to machine, and from run to run.
const std::set<std::string> kOfMachine = {"services", "realtime_factor", "wall_s"};
// Responses of the fault protection that do not stop the rover.
const std::set<std::string> kDriveOn = {"log", "slow"};

Json json_value(const std::string& text) {
  if (const auto whole = parse_whole_number(text)) return *whole;
  if (const auto number = parse_number(text)) return *number;
  return text;
}

Json cell_json(const Cell& cell) {
  Json json = Json::object();
  for (const auto& [axis, value] : cell) json[axis] = json_value(value);
  return json;
}

Cell cell_of(const Json& json) {
  Cell cell;
  for (const auto& [axis, value] : json.items())
    cell[axis] = value.is_string() ? value.get<std::string>() : short_value(value.dump());
  return cell;
}

void add_scalar(const std::string& name, const Json& value, Row& row) {
  if (value.is_boolean()) row.figures[name] = value.get<bool>() ? 1.0 : 0.0;
  if (value.is_number()) row.figures[name] = value.get<double>();
  if (value.is_string()) row.texts[name] = value.get<std::string>();
}

void add_members(const std::string& prefix, const Json& json, Row& row) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object())
      add_members(prefix + key + ".", value, row);
    else
      add_scalar(prefix + key, value, row);
  }
}

// Of those that stopped the rover, the one that was the last to begin.
std::string last_fault(const Json& metrics) {
  std::string last;
  const auto fdir = metrics.find("fdir");
  if (fdir == metrics.end() || !fdir->is_array()) return last;
  for (const Json& fault : *fdir)
    if (fault.is_object() && !kDriveOn.contains(fault.value("response", ""))) last = fault.value("id", "");
  return last;
}

}  // namespace

std::string short_value(const std::string& text) {
  if (const auto whole = parse_whole_number(text)) return std::to_string(*whole);
  const auto number = parse_number(text);
  if (!number) return text;
  constexpr double kMaxWhole = 1e15;
  if (std::abs(*number) < kMaxWhole && *number == std::floor(*number))
    return std::to_string(static_cast<std::int64_t>(*number));
  return Json(*number).dump();
}

std::string cell_text(const Cell& cell) {
  return cell_json(cell).dump();
}

Cell parse_cell(const std::string& text) {
  return cell_of(Json::parse(text));
}

void add_metrics(const Json& metrics, Row& row) {
  for (const auto& [key, value] : metrics.items()) {
    if (kKeys.contains(key) || kOfMachine.contains(key)) continue;
    if (value.is_object())
      add_members(key + ".", value, row);
    else
      add_scalar(key, value, row);
  }
  row.outcome = metrics.value("outcome", "");
  if (const std::string fault = last_fault(metrics); !fault.empty()) row.texts["fault"] = fault;
}

std::string json_line(const Row& row) {
  Json json = {{"commit", row.commit},     {"cell", cell_json(row.cell)}, {"seed", row.seed},
               {"attempts", row.attempts}, {"status", row.status},        {"outcome", row.outcome}};
  for (const auto& [name, value] : row.figures) json[name] = value;
  for (const auto& [name, value] : row.texts) json[name] = value;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Row parse_row(const std::string& line, const std::string& where) try {
  const Json json = Json::parse(line);
  Row row;
  row.commit = json.at("commit").get<std::string>();
  row.cell = cell_of(json.at("cell"));
  row.seed = json.at("seed").get<std::int64_t>();
  row.attempts = json.at("attempts").get<int>();
  row.status = json.at("status").get<std::string>();
  row.outcome = json.at("outcome").get<std::string>();
  for (const auto& [name, value] : json.items())
    if (!kKeys.contains(name)) add_scalar(name, value, row);
  return row;
} catch (const Json::exception& error) {
  throw ConfigError(where + ": not a row of a campaign: " + error.what());
}

}  // namespace rover::campaign
