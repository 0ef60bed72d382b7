// Parses an operator command from the JSON body of a request. Anything else is rejected with an error text.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "common/core/zones.hpp"

namespace rover::mission {

enum class CommandKind {
  kGo,
  kStop,
  kPause,
  kResume,
  kEmergencyStop,
  kClearSafe,
  kForceLevel,
  kClearFault,
  kLocate,
  kPath,
  kZones,
  kKill,
  kHang
};

enum class Level { kEfficient, kFull, kAuto };

struct Command {
  CommandKind kind = CommandKind::kStop;
  Level level = Level::kAuto;           // kForceLevel; kPath: level of all points, kEfficient or kFull
  std::string target;                   // kClearFault: the fault's id; kKill, kHang: the service
  std::vector<Eigen::Vector2d> points;  // kPath: waypoints in map coordinates [m]
  std::vector<Zone> zones;              // kZones: in place of all before
  double within_m = 0.0;                // kLocate: of the estimated position
};

struct CommandLimits {
  size_t max_points = 500;
  double max_coordinate_m = 1e6;
  double max_within_m = 1000.0;
};

struct ParsedCommand {
  std::optional<Command> command;
  std::string error;  // set if there is no command
};

ParsedCommand parse_command(const std::string& json, const CommandLimits& limits);

// Parses a request that contains only "points".
struct ParsedPoints {
  std::vector<Eigen::Vector2d> points;
  std::string error;
};
ParsedPoints parse_points(const std::string& json, const CommandLimits& limits);

// Name used in the request: "go", "force_level" ...
std::string name(CommandKind kind);
// Text for the event list: "GO", "FORCE LEVEL full" ...
std::string description(const Command& command);
// True if the command ends or forbids motion. Such a command is sent even if late, and cancels the mission plan.
bool stops(CommandKind kind);
// True if the command acts on processes instead of the bus.
bool is_injection(CommandKind kind);

}  // namespace rover::mission
