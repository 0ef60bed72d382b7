// Distance driven, from successive positions.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace rover::@NAME@ {

struct @CLASS@Config {
  double min_step_m = 0.02;
};

class @CLASS@ {
 public:
  explicit @CLASS@(const @CLASS@Config& config) : config_(config) {}

  // Returns the distance up to this position, which must be finite.
  double step(const Eigen::Vector3d& p_odom_body_m);

 private:
  @CLASS@Config config_;
  std::optional<Eigen::Vector3d> last_m_;
  double distance_m_ = 0.0;
};

}  // namespace rover::@NAME@
