// Programs that a command needs. The Full level's services are built only on demand.
#pragma once

#include "tools/launcher/arguments.hpp"
#include "tools/launcher/drive_command.hpp"
#include "tools/launcher/replay_command.hpp"

namespace rover {

// True if the Full level may be used. Invalid arguments are reported by the command itself.
bool needs_full_level(const RunArguments& run);
bool needs_full_level(const DriveArguments& drive);
bool needs_full_level(const ReplayArguments& replay);

}  // namespace rover
