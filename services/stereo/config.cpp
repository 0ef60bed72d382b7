#include "stereo/config.hpp"

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/stereo/matcher_config.hpp"

namespace rover::stereo {

NodeConfig load_config(const std::string& config_dir) {
  NodeConfig config;
  config.rig = load_stereo_rig(config_dir, "loccam");
  config.origin_height_m = load_vehicle(config_dir).origin_height_m;
  const Config yaml = Config::load(config_dir + "/stereo.yaml");
  double latency_s = to_seconds(config.latency_us);
  yaml.read("latency_s", latency_s, {0.02, 5.0});
  config.latency_us = to_utime(latency_s);
  yaml.read("ground_reference", config.core.ground_reference);
  read_matcher(yaml.section("matcher"), config.core.matcher);
  yaml.finish();
  return config;
}

}  // namespace rover::stereo
