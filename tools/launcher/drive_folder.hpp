// The folder of a drive: the effective configuration, the ground's orders and the orbital map.
#pragma once

#include "tools/launcher/drive_command.hpp"
#include "tools/launcher/run_folder.hpp"

namespace rover {

// Throws ConfigError with one line where something is missing or not right; nothing is left of the folder then.
RunFolder make_drive_folder(const DriveArguments& arguments);
// A message that names files of the drive's own configuration, with the names of the user's instead.
std::string in_users_files(std::string message, const RunFolder& folder, const DriveArguments& arguments);

}  // namespace rover
