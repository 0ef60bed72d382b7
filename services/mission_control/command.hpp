// What an operator may ask for through the page, from the text of a request. All that is not exactly one of these is an
// error in words.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

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
  kPath,
  kKill,
  kHang
};

enum class Level { kEfficient, kFull, kAuto };

struct Command {
  CommandKind kind = CommandKind::kStop;
  Level level = Level::kAuto;           // kForceLevel; kPath: of all its points, kEfficient or kFull
  std::string target;                   // kClearFault: the fault's id; kKill, kHang: the service
  std::vector<Eigen::Vector2d> points;  // kPath: way-points in map coordinates [m]
};

struct CommandLimits {
  size_t most_points = 500;
  double most_coordinate_m = 1e6;
};

struct ParsedCommand {
  std::optional<Command> command;
  std::string error;  // where there is none
};

ParsedCommand parse_command(const std::string& json, const CommandLimits& limits);

// The "points" of a request, which hold nothing else.
struct ParsedPoints {
  std::vector<Eigen::Vector2d> points;
  std::string error;
};
ParsedPoints parse_points(const std::string& json, const CommandLimits& limits);

// As in the request: "go", "force_level" ...
std::string name(CommandKind kind);
// For the time line: "GO", "FORCE LEVEL full" ...
std::string description(const Command& command);
// Ends or forbids motion: worth giving however late, and the end of any plan of the ground.
bool stops(CommandKind kind);
// Carried out on processes, not on the bus.
bool is_injection(CommandKind kind);

}  // namespace rover::mission
