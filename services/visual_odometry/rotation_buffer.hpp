// Rotation of the body between two times, from gyro increments.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "common/core/time.hpp"

namespace rover::vo {

struct GyroIncrement {
  Utime utime = kNever;  // end of the interval
  double dt_s = 0.0;
  Eigen::Vector3d delta_angle_rad = Eigen::Vector3d::Zero();
};

class RotationBuffer {
 public:
  // Keeps increments this long.
  explicit RotationBuffer(Utime span_us);

  // False, and nothing stored, where the increment is not finite, too large for a rover or not newer than the last.
  bool add(const GyroIncrement& increment);

  // R_from_to; nothing where the increments leave a hole in the interval.
  std::optional<Eigen::Matrix3d> rotation(Utime from, Utime to) const;

 private:
  Utime span_us_;
  std::deque<GyroIncrement> increments_;
};

}  // namespace rover::vo
