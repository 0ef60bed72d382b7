// Prepares the folder of a drive: effective configuration, mission plan and orbital map.
#pragma once

#include "tools/launcher/drive_command.hpp"
#include "tools/launcher/run_folder.hpp"

namespace rover {

// Throws ConfigError with one line on invalid input, and removes the folder.
RunFolder make_drive_folder(const DriveArguments& arguments);
// Replaces the drive's own file names in a message with the user's.
std::string in_users_files(std::string message, const RunFolder& folder, const DriveArguments& arguments);

}  // namespace rover
