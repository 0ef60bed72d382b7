// A piece of a path: an arc driven forward or in reverse, or a point turn.
#pragma once

#include <cmath>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::oracle {

struct Piece {
  Pose2 from;
  double driven_m = 0.0;  // negative: in reverse; 0: point turn
  double curvature_per_m = 0.0;
  double turn_rad = 0.0;  // of a point turn

  bool is_turn() const { return driven_m == 0.0; }
  double length_m() const { return std::abs(driven_m); }
  // At a fraction of the piece.
  Pose2 pose_at(double u) const {
    if (is_turn()) return {from.x_m, from.y_m, from.yaw_rad + u * turn_rad};
    const double s = u * driven_m;
    const double half = 0.5 * curvature_per_m * s;
    const double chord = std::abs(half) < 1e-9 ? s : s * std::sin(half) / half;
    return {from.x_m + chord * std::cos(from.yaw_rad + half), from.y_m + chord * std::sin(from.yaw_rad + half),
            from.yaw_rad + 2.0 * half};
  }
  Pose2 to() const { return pose_at(1.0); }
};

using Pieces = std::vector<Piece>;

inline double length_m(const Pieces& path) {
  double sum = 0.0;
  for (const Piece& piece : path) sum += piece.length_m();
  return sum;
}

// Prefers few point turns and cusps among paths of equal length; in all far below the accuracy asked for.
struct TieCosts {
  static constexpr double kTurnM = 0.05;
  static constexpr double kTurnMPerRad = 0.02;
  static constexpr double kCuspM = 0.05;
  static constexpr double kReverse = 0.001;    // per metre
  static constexpr double kCurvature = 0.002;  // per metre at the largest curvature
};

}  // namespace rover::oracle
