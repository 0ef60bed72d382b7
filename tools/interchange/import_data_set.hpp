// ./rover import: converts a stereo data set to the log of a run, with its configuration.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace rover::interchange {

struct ImportOptions {
  std::string data_set;        // folder
  std::string out;             // run folder; new or empty
  std::string config_dir;      // project configuration
  std::string poses;           // KITTI: ground truth file; empty: poses.txt in the folder
  double rate_hz = 10.0;       // KITTI without times.txt
  int max_disparity_px = 128;  // maximum disparity (minimum range); a multiple of 16
  double max_speed_mps = 60.0;
};

class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns a summary. Throws ConfigError, or Interrupted on SIGINT and SIGTERM (common/bus/interrupt.hpp); then nothing
// is left.
std::vector<std::string> import_data_set(const ImportOptions& options);

}  // namespace rover::interchange
