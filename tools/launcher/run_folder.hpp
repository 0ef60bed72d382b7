// A run's folder: the effective configuration, the orbital map and the ground's orders, laid out before anything
// starts.
#pragma once

#include <string>
#include <vector>

#include "tools/launcher/arguments.hpp"

namespace rover {

struct RunFolder {
  std::string dir;         // absolute
  std::string config_dir;  // dir/config: the effective configuration
  std::string scenario;    // dir/config/scenario.yaml
  std::string bus_url;
  std::int64_t seed = 0;
  bool has_faults = false;             // the scenario injects some
  bool is_new = true;                  // false: an empty folder was there already
  std::string level = "efficient";     // auto, full: with the services of the Full level
  std::vector<std::string> map_notes;  // for the user: what of the elevation model was converted or taken for void
};

// Throws ConfigError with one line where the scenario, a key or a value is not right, or the folder is not writable;
// nothing is left of the folder then.
RunFolder make_run_folder(const RunArguments& arguments);
// Of a replay: the configuration in `config_from`, and the orbital map where the folder of the log has one. Throws
// likewise.
RunFolder make_replay_folder(const RunArguments& arguments, const std::string& name, const std::string& config_from,
                             const std::string& log_dir);
// A message that names files of the run's own configuration, with the names of the user's folder instead.
std::string in_users_files(const std::string& message, const RunFolder& folder, const std::string& users_config_dir);
// Takes back what make_run_folder made, for a run that never began.
void remove_run_folder(const RunFolder& folder);

// The steps of it, for other kinds of run.
// Absolute; `out` empty: logs/<time>-<name>.
std::string run_dir_for(const std::string& source_dir, const std::string& out, const std::string& name);
// Makes the folder with its parts; throws ConfigError where it is there already and not empty.
void create_folders(const std::string& run_dir);
void copy_configuration(const std::string& from, const std::string& to);
// One setting "file.key.key=value" in the run's copy of the configuration.
void apply_setting(const std::string& setting, const std::string& config_dir);

}  // namespace rover
