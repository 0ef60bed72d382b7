// ./rover import: a stereo data set as the log of a run, with its configuration.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace rover::interchange {

struct ImportOptions {
  std::string data_set;        // folder
  std::string out;             // the run's folder; new, or empty
  std::string config_dir;      // the project's
  std::string poses;           // KITTI: file of the ground truth, empty: poses.txt in the folder
  double rate_hz = 10.0;       // KITTI without times.txt
  int max_disparity_px = 128;  // the nearest that stereo sees; a multiple of 16
  double max_speed_mps = 60.0;
};

class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Lines that say what was written and what was left out. Throws ConfigError with one line, or Interrupted after SIGINT
// and SIGTERM (common/bus/interrupt.hpp); nothing is left then.
std::vector<std::string> import_data_set(const ImportOptions& options);

}  // namespace rover::interchange
