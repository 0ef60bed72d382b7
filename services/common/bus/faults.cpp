#include "common/bus/faults.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "common/bus/channels.hpp"
#include "common/bus/field_faults.hpp"
#include "common/bus/service_names.hpp"

namespace rover {
namespace {

using enum FaultTarget;

constexpr Range kNone{0.0, 0.0};
constexpr Range kFraction{0.0, 1.0};
constexpr double kRequired = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> kWheels = {"0", "1", "2", "3", "4", "5"};

const std::vector<std::string> kLenses = {"left", "right", "both", "navcam_left", "navcam_right", "navcam"};

const std::vector<FaultKind>& table() {
  static const std::vector<FaultKind> kTable = {
      {"kill", kService, {}, "", kNone, 0.0, false, "kills the process; s6 restarts it"},
      {"hang", kService, {}, "", kNone, 0.0, false, "stops the process (SIGSTOP)"},
      {"restart_loop", kService, {}, "times", {2, 20}, 3.0, false, "kills the process again after each restart"},
      {"slow", kSlow, {}, "s", {0.02, 10}, 0.5, true, "all messages of the service are delayed"},
      {"drop", kChannel, {}, "fraction", kFraction, 1.0, true, "messages are lost"},
      {"delay", kChannel, {}, "s", {0.02, 60}, 0.5, true, "messages are delayed"},
      {"duplicate", kChannel, {}, "fraction", kFraction, 1.0, true, "messages are received twice"},
      {"reorder", kChannel, {}, "fraction", kFraction, 0.3, true, "messages are received after later ones"},
      {"corrupt", kChannel, {}, "fraction", kFraction, 1.0, true, "one bit of a message is flipped"},
      {"freeze", kChannel, {}, "", kNone, 0.0, true, "the content of the first message is repeated"},
      {"nan", kField, {}, "fraction", kFraction, 1.0, true, "values become NaN"},
      {"offset", kField, {}, "field's unit", {-1e6, 1e6}, kRequired, true, "added to the values of one field"},
      {"loss", kBus, {"*"}, "fraction", {0.01, 0.5}, 0.1, true, "messages of all channels are lost"},
      {"camera_blind", kWorld, kLenses, "", kNone, 0.0, true, "black images; both: of the LocCam"},
      {"camera_frozen", kWorld, kLenses, "", kNone, 0.0, true, "the same image is repeated"},
      {"camera_rows", kWorld, kLenses, "px", {-50, 50}, 3.0, true, "images shifted downwards"},
      {"camera_columns", kWorld, kLenses, "px", {-50, 50}, 3.0, true, "images shifted to the right"},
      {"camera_roll", kWorld, kLenses, "deg", {-5, 5}, 0.5, true, "images turned about their centre"},
      {"camera_fog", kWorld, kLenses, "fraction", kFraction, 0.8, true, "images of low contrast and blurred"},
      {"camera_dirt", kWorld, kLenses, "fraction", {0, 0.9}, 0.3, true, "dark spots that stay in place"},
      {"camera_glare", kWorld, kLenses, "of the width", {0, 1}, 0.3, true, "the sun in the image"},
      {"imu_dead", kWorld, {"imu"}, "", kNone, 0.0, true, "no IMU messages"},
      {"gyro_bias", kWorld, {"imu"}, "rad/s", {-2, 2}, 0.05, true, "on the yaw rate, fibre-optic gyro included"},
      {"accel_bias", kWorld, {"imu"}, "m/s2", {-20, 20}, 0.5, true, "on the forward acceleration"},
      {"encoder_stuck", kWorld, kWheels, "", kNone, 0.0, true, "the wheel's encoder reports no motion"},
      {"wheel_jammed", kWorld, kWheels, "", kNone, 0.0, true, "the wheel does not turn; its motor stalls"},
      {"loose_sand", kWorld, {"ground"}, "", kNone, 0.0, true, "loose sand under all wheels"},
      {"tilt_roll", kWorld, {"ground"}, "deg", {-60, 60}, kRequired, true, "gravity as on a slope across the heading"},
      {"tilt_pitch",
       kWorld,
       {"ground"},
       "deg",
       {-60, 60},
       kRequired,
       true,
       "gravity as on a slope along it, nose down"},
      {"clock_step", kWorld, {"clock"}, "s", {0.02, 3600}, kRequired, false, "message time jumps ahead once"},
      {"full_disk", kRecorder, {"recorder"}, "", kNone, 0.0, true, "the recorder finds no space"},
  };
  return kTable;
}

std::string joined(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text;
}

std::string usual_target(const FaultKind& kind) {
  if (!kind.targets.empty()) {
    std::string text;
    for (const std::string& target : kind.targets) text += (text.empty() ? "" : "|") + target;
    return text;
  }
  if (kind.on == kField) return "CHANNEL.field";
  return kind.on == kChannel ? "CHANNEL" : "SERVICE";
}

std::string service_problem(const std::string& target) {
  const std::vector<std::string> names = service_names(true);
  if (std::find(names.begin(), names.end(), target) != names.end()) return "";
  return "'" + target + "' is not a service; there are " + joined(names);
}

// Faults on TICK, DONE and INJECT would stop the simulation or the injection itself.
std::string channel_problem(const std::string& channel, FindChannelType types) {
  static const std::set<std::string> kExcluded = {channel::kTick, channel::kDone, channel::kInject};
  if (types(channel) == nullptr) return "'" + channel + "' is not a channel";
  return kExcluded.contains(channel) ? "no fault can be put on " + channel : "";
}

std::string field_problem(const FaultKind& kind, const std::string& target, FindChannelType types) {
  const FieldTarget at = split_field(target);
  if (std::string problem = channel_problem(at.channel, types); !problem.empty()) return problem;
  const std::vector<std::string> fields = fields_of(at.channel);
  if (fields.empty()) return at.channel + " has no fields for the fault " + kind.name;
  if (at.field.empty())
    return kind.name == "offset" ? "a field is required, for example " + at.channel + "." + fields.front() : "";
  if (std::find(fields.begin(), fields.end(), at.field) != fields.end()) return "";
  return at.channel + " has no field '" + at.field + "'; there are " + joined(fields);
}

}  // namespace

const std::vector<FaultKind>& fault_kinds() {
  return table();
}

const FaultKind* find_fault(const std::string& name) {
  for (const FaultKind& kind : table())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::string fault_names() {
  std::vector<std::string> names;
  for (const FaultKind& kind : table()) names.push_back(kind.name);
  return joined(names);
}

std::string target_problem(const FaultKind& kind, const std::string& target, FindChannelType types) {
  if (!kind.targets.empty()) {
    const bool known = std::find(kind.targets.begin(), kind.targets.end(), target) != kind.targets.end();
    return known ? "" : "'" + target + "' is not one of " + joined(kind.targets);
  }
  switch (kind.on) {
    case kService:
    case kSlow:
      return service_problem(target);
    case kField:
      return field_problem(kind, target, types);
    default:
      return channel_problem(target, types);
  }
}

std::string amount_problem(const FaultKind& kind, double amount) {
  if (kind.unit.empty()) return amount == 0.0 ? "" : kind.name + " takes no amount";
  if (std::isfinite(amount) && amount >= kind.amount.min && amount <= kind.amount.max) return "";
  std::ostringstream text;
  text << "out of range [" << kind.amount.min << ", " << kind.amount.max << "] " << kind.unit;
  return text.str();
}

std::string fault_list() {
  std::string text;
  for (const FaultKind& kind : table()) {
    std::ostringstream amount;
    if (!kind.unit.empty()) {
      amount << kind.amount.min << ".." << kind.amount.max << " " << kind.unit;
      if (std::isfinite(kind.default_amount)) amount << " (" << kind.default_amount << ")";
    }
    char line[256];
    std::snprintf(line, sizeof line, "%-15s %-16s %-28s %s\n", kind.name.c_str(), usual_target(kind).c_str(),
                  amount.str().c_str(), kind.description.c_str());
    text += line;
  }
  return text;
}

}  // namespace rover
