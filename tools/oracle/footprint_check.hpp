// Whether the rover fits on the true ground: no hazard of the wheels under a wheel, none of the body under the
// footprint, no slope beyond the limit. Exact, without margin.
#pragma once

#include "common/core/vehicle.hpp"
#include "tools/oracle/path_piece.hpp"
#include "tools/oracle/true_ground.hpp"

namespace rover::oracle {

class FootprintCheck {
 public:
  FootprintCheck(const Vehicle& vehicle, TrueGround& ground)
      : vehicle_(vehicle),
        half_length_m_(vehicle.footprint_half_length_m() + kHalfCellM),
        half_width_m_(vehicle.footprint_half_width_m() + kHalfCellM),
        ground_(ground) {}

  bool is_free(const Pose2& pose) const;
  // At all poses of the piece but its first.
  bool is_free(const Piece& piece) const;

 private:
  static constexpr double kHalfCellM = 0.5 * TrueGround::kCellM;

  bool on_wheel(double x_m, double y_m) const;

  const Vehicle& vehicle_;
  double half_length_m_;
  double half_width_m_;
  TrueGround& ground_;
};

}  // namespace rover::oracle
