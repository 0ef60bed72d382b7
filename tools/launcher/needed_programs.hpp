// Which programs a command needs: the Full level's services are built only where they are wanted.
#pragma once

#include "tools/launcher/arguments.hpp"
#include "tools/launcher/drive_command.hpp"
#include "tools/launcher/replay_command.hpp"

namespace rover {

// Whether the Full level may be reached. What is wrong with the arguments is for the command itself to say.
bool needs_full_level(const RunArguments& run);
bool needs_full_level(const DriveArguments& drive);
bool needs_full_level(const ReplayArguments& replay);

}  // namespace rover
