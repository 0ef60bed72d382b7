#include "parsers.hpp"

namespace rover::fuzz {

std::vector<Parser> all_parsers() {
  return {scenario_parser(), settings_parser(),    arguments_parser(), maps_parser(),    kitti_parser(),
          euroc_parser(),    calibration_parser(), logs_parser(),      requests_parser()};
}

}  // namespace rover::fuzz
