#include "mission_control/command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mission_control/zones_json.hpp"

namespace rover::mission {
namespace {

using nlohmann::json;

constexpr size_t kMaxNameLength = 64;
constexpr int kMaxDepth = 6;

struct Form {
  const char* name;
  CommandKind kind;
  const char* argument;  // name of its only argument; null: none
};

constexpr std::array kForms = {Form{"go", CommandKind::kGo, nullptr},
                               Form{"stop", CommandKind::kStop, nullptr},
                               Form{"pause", CommandKind::kPause, nullptr},
                               Form{"resume", CommandKind::kResume, nullptr},
                               Form{"emergency_stop", CommandKind::kEmergencyStop, nullptr},
                               Form{"clear_safe", CommandKind::kClearSafe, nullptr},
                               Form{"force_level", CommandKind::kForceLevel, "level"},
                               Form{"clear_fault", CommandKind::kClearFault, "fault"},
                               Form{"locate", CommandKind::kLocate, "within_m"},
                               Form{"path", CommandKind::kPath, "points"},
                               Form{"zones", CommandKind::kZones, "zones"},
                               Form{"kill", CommandKind::kKill, "service"},
                               Form{"hang", CommandKind::kHang, "service"}};

// Returns null unless the text is a JSON object. Nesting is limited because copying a value recurses: a few thousand
// brackets would overflow the stack.
json object_from(const std::string& text) {
  bool too_deep = false;
  const auto keep = [&](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > kMaxDepth;
    return !too_deep;
  };
  json parsed = json::parse(text, keep, false);
  if (too_deep || !parsed.is_object()) return {};
  return parsed;
}

const Form* find_form(const json& request) {
  const auto command = request.find("command");
  if (command == request.end() || !command->is_string()) return nullptr;
  const auto form = std::find_if(kForms.begin(), kForms.end(), [&](const Form& f) { return *command == f.name; });
  return form == kForms.end() ? nullptr : &*form;
}

std::optional<Level> level_from(const json& value) {
  if (value == "efficient") return Level::kEfficient;
  if (value == "full") return Level::kFull;
  if (value == "auto") return Level::kAuto;
  return std::nullopt;
}

// Valid fault and service names: letters, digits, '_', '.', '-'.
bool is_name(const json& value) {
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  return !text.empty() && text.size() <= kMaxNameLength && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-';
  });
}

std::string read_points(const json& value, const CommandLimits& limits, std::vector<Eigen::Vector2d>& points) {
  if (!value.is_array() || value.size() < 2) return "points: a list of at least 2 points [x, y] is required";
  if (value.size() > limits.max_points) return "points: more than " + std::to_string(limits.max_points) + " waypoints";
  for (const json& point : value) {
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      return "points: each point must be [x, y], two numbers";
    const Eigen::Vector2d p(point[0].get<double>(), point[1].get<double>());
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > limits.max_coordinate_m) return "points: out of range";
    points.push_back(p);
  }
  return "";
}

std::string read_path(const json& request, const CommandLimits& limits, Command& command) {
  command.level = Level::kEfficient;
  if (const auto level = request.find("level"); level != request.end()) {
    const auto level_value = level_from(*level);
    if (!level_value || *level_value == Level::kAuto) return "level: must be efficient or full";
    command.level = *level_value;
  }
  return read_points(request.at("points"), limits, command.points);
}

std::string read_zones(const json& value, Command& command) {
  try {
    command.zones = zones_from(value);
  } catch (const json::exception&) {
    return "zones: a list of {name, kind: keep_out or keep_in, points: [[x, y], ...]} is required";
  }
  return zones_problem(command.zones);
}

std::string whole(double value) {
  return std::to_string(std::lround(value));
}

std::string read_within(const json& value, const CommandLimits& limits, Command& command) {
  if (value.is_number()) command.within_m = value.get<double>();
  return command.within_m > 0.0 && command.within_m <= limits.max_within_m
             ? ""
             : "within_m: a number of metres above 0, up to " + whole(limits.max_within_m) + ", is required";
}

std::string read_argument(const Form& form, const json& request, const CommandLimits& limits, Command& command) {
  if (form.argument == nullptr) return "";
  const auto value = request.find(form.argument);
  if (value == request.end()) return std::string(form.argument) + " is missing";
  if (form.kind == CommandKind::kPath) return read_path(request, limits, command);
  if (form.kind == CommandKind::kZones) return read_zones(*value, command);
  if (form.kind == CommandKind::kLocate) return read_within(*value, limits, command);
  if (form.kind == CommandKind::kForceLevel) {
    const auto level = level_from(*value);
    if (!level) return "level: must be efficient, full or auto";
    command.level = *level;
    return "";
  }
  if (!is_name(*value)) return std::string(form.argument) + ": invalid name";
  command.target = value->get<std::string>();
  return "";
}

std::string unknown_key(const Form& form, const json& request) {
  for (const auto& [key, value] : request.items()) {
    const bool known = key == "command" || (form.argument != nullptr && key == form.argument) ||
                       (form.kind == CommandKind::kPath && key == "level");
    if (!known) return "unknown key";
  }
  return "";
}

const char* name(Level level) {
  return level == Level::kFull ? "full" : level == Level::kEfficient ? "efficient" : "auto";
}

}  // namespace

ParsedCommand parse_command(const std::string& text, const CommandLimits& limits) {
  const json request = object_from(text);
  if (request.is_null()) return {std::nullopt, "a JSON object is required"};
  const Form* form = find_form(request);
  if (form == nullptr) return {std::nullopt, "unknown command"};
  Command command;
  command.kind = form->kind;
  std::string error = unknown_key(*form, request);
  if (error.empty()) error = read_argument(*form, request, limits, command);
  if (!error.empty()) return {std::nullopt, std::string(form->name) + ": " + error};
  return {command, ""};
}

ParsedPoints parse_points(const std::string& text, const CommandLimits& limits) {
  const json request = object_from(text);
  ParsedPoints out;
  if (request.is_null() || request.size() != 1 || !request.contains("points")) {
    out.error = "a JSON object with points is required";
    return out;
  }
  out.error = read_points(request["points"], limits, out.points);
  return out;
}

std::string name(CommandKind kind) {
  for (const Form& form : kForms)
    if (form.kind == kind) return form.name;
  return "?";
}

std::string description(const Command& command) {
  std::string text = name(command.kind);
  std::replace(text.begin(), text.end(), '_', ' ');
  if (command.kind == CommandKind::kForceLevel) text += std::string(" ") + name(command.level);
  if (command.kind == CommandKind::kPath) text += " with " + std::to_string(command.points.size()) + " waypoints";
  if (command.kind == CommandKind::kZones) text += " (" + std::to_string(command.zones.size()) + ")";
  if (command.kind == CommandKind::kLocate) text += " within " + whole(command.within_m) + " m";
  return command.target.empty() ? text : text + " " + command.target;
}

bool stops(CommandKind kind) {
  return kind == CommandKind::kStop || kind == CommandKind::kPause || kind == CommandKind::kEmergencyStop;
}

bool is_injection(CommandKind kind) {
  return kind == CommandKind::kKill || kind == CommandKind::kHang;
}

}  // namespace rover::mission
