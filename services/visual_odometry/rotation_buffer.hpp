// Buffer of gyro increments, integrated to the body's rotation between two times.
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
  explicit RotationBuffer(Utime span_us);

  // False, without storing it, if the increment is not finite, implausibly large or not newer than the last.
  bool add(const GyroIncrement& increment);

  // R_from_to; empty if increments are missing in the interval.
  std::optional<Eigen::Matrix3d> rotation(Utime from, Utime to) const;

 private:
  Utime span_us_;
  std::deque<GyroIncrement> increments_;
};

}  // namespace rover::vo
