#include "@NAME@/config.hpp"

namespace rover::@NAME@ {

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  Parameters p(config_dir + "/@NAME@.yaml", "Distance driven.", list);
  p.add("min_step_m", config.core.min_step_m, {0.001, 1.0}, "shorter steps are vibration");
  p.add("max_pose_age_s", config.max_pose_age_s, {0.02, 60.0}, "without a newer POSE the heartbeat is DEGRADED");
  p.finish();
  return config;
}

}  // namespace rover::@NAME@
