// Prepares a run folder before anything starts: effective configuration, orbital map and mission plan.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/arguments.hpp"

namespace rover {

struct RunFolder {
  std::string dir;                     // absolute
  std::string config_dir;              // dir/config: the effective configuration
  std::string scenario;                // dir/config/scenario.yaml
  std::string bus_url;                 // empty: of config_dir
  std::vector<std::string> set_files;  // of config_dir, changed by --set
  std::int64_t seed = 0;
  bool has_faults = false;             // the scenario injects faults
  bool is_new = true;                  // false: an empty folder existed
  std::string level = "efficient";     // auto, full: with the services of the Full level
  std::vector<std::string> map_notes;  // for the user: conversions and void values of the elevation model
};

// Throws ConfigError with one line if the scenario, a key or a value is invalid or the folder is not writable, and
// removes the folder.
RunFolder make_run_folder(const RunArguments& arguments);
// For a replay: copies the configuration of `config_from` and the orbital map of the log's folder, if any. Throws
// ConfigError.
RunFolder make_replay_folder(const RunArguments& arguments, const std::string& name, const std::string& config_from,
                             const std::string& log_dir);
// Of the files changed by --set: the lines of the run's copy are not those of the user's file.
std::string without_lines(std::string message, const RunFolder& folder);
// The same, and replaces the run's own file names in a message with those of the user's folder.
std::string in_users_files(const std::string& message, const RunFolder& folder, const std::string& users_config_dir);
// Removes what make_run_folder created, for a run that never began.
void remove_run_folder(const RunFolder& folder);

// Steps of make_run_folder, for other kinds of run.
// Creates `out`, which may be an empty folder, or a new logs/<time>-<name>, with its subfolders. Throws ConfigError if
// it is not empty.
RunFolder create_folders(const std::string& source_dir, const std::string& out, const std::string& name);
void copy_configuration(const std::string& from, const std::string& to);
// Changes the run's copy of the configuration as the options of a command say.
void apply_settings(bool headless, const std::string& record, const std::vector<std::string>& set, RunFolder& folder);
// Applies "file.key.key=value" to it.
void apply_setting(const std::string& setting, const std::string& config_dir);

}  // namespace rover
