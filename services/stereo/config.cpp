#include "stereo/config.hpp"

#include "common/bus/vehicle_config.hpp"
#include "common/stereo/matcher_config.hpp"

namespace rover::stereo {

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  config.rig = load_stereo_rig(config_dir, "loccam");
  config.origin_height_m = load_vehicle(config_dir).origin_height_m;
  Parameters p(config_dir + "/stereo.yaml",
               "Rectification and dense disparity of the LocCam. Image size and calibration: cameras.yaml.", list);
  p.add_s("latency_s", config.latency_us, {0.02, 5.0}, "modelled processing time, images to disparity");
  p.add("ground_reference", config.core.ground_reference, "search about the disparity of flat ground under the rover");
  add_matcher(p.section("matcher",
                        "block matching; -16 px: ground 10 deg lower ahead needs -12, a hole of 0.4 m -15; +47 px: the "
                        "face of a rock 0.4 m tall at the front wheels"),
              config.core.matcher);
  p.finish();
  return config;
}

}  // namespace rover::stereo
