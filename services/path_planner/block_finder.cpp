#include "path_planner/block_finder.hpp"

namespace rover::planning {
namespace {

constexpr double kStepM = 0.05;
constexpr double kTurnStepRad = 0.0524;
constexpr double kMergeM = 1.0;  // the controller takes a cross-track error out within about this way

class BlockFinder {
 public:
  explicit BlockFinder(const BlockQuery& query)
      : query_(query), check_(query.terrain, query.footprint, query.margin_m, 0.0, query.start.value_or(query.rover)) {}

  Block run() {
    const Pose2 here = query_.route.pose_at(query_.from_m);
    const bool turning = query_.turning;
    if (turning) look_at_turn(query_.rover, wrap_angle(here.yaw_rad - query_.rover.yaw_rad), query_.from_m);
    // After a point turn the camera has seen what lies ahead; until then nothing can be said of it.
    bool known = !turning;
    size_t kink = 0;
    const std::vector<size_t>& kinks = query_.route.kinks();
    for (double s = query_.from_m; s <= query_.route.length_m() && !complete(); s += kStepM) {
      while (kink < kinks.size() && query_.route.s_at(kinks[kink]) < s) {
        if (query_.route.s_at(kinks[kink]) > query_.from_m && look_at_kink(kinks[kink], s)) known = false;
        ++kink;
      }
      const Pose2 pose = expected_pose(s, here, turning);
      if (!query_.terrain.contains(position(pose))) break;
      note(pose, s, known);
    }
    return block_;
  }

 private:
  bool complete() const { return std::isfinite(block_.confirmed_m) && std::isfinite(block_.unseen_m); }

  // False where the bend is so small that the rover does not halt for it.
  bool look_at_kink(size_t i, double s_m) {
    const double turn = wrap_angle(query_.route.yaw_out_of(i) - query_.route.yaw_into(i));
    if (std::abs(turn) <= query_.turn_threshold_rad) return false;
    const Point2 p = query_.route.points()[i].p;
    look_at_turn({p.x_m, p.y_m, query_.route.yaw_into(i)}, turn, s_m);
    return true;
  }

  void look_at_turn(Pose2 pose, double turn_rad, double s_m) {
    const int steps = 1 + static_cast<int>(std::abs(turn_rad) / kTurnStepRad);
    for (int i = 0; i <= steps; ++i) {
      note(pose, s_m, true);
      pose.yaw_rad += turn_rad / steps;
    }
  }

  // The path's pose, moved by what is left of the rover's error.
  Pose2 expected_pose(double s_m, const Pose2& here, bool turning) const {
    Pose2 pose = query_.route.pose_at(s_m);
    const double left = std::max(0.0, 1.0 - (s_m - query_.from_m) / kMergeM);
    pose.x_m += left * (query_.rover.x_m - here.x_m);
    pose.y_m += left * (query_.rover.y_m - here.y_m);
    if (!turning) pose.yaw_rad += left * wrap_angle(query_.rover.yaw_rad - here.yaw_rad);
    return pose;
  }

  void note(const Pose2& pose, double s_m, bool look_for_unseen) {
    if (std::isinf(block_.confirmed_m) && !check_.clear_of(pose, true)) block_.confirmed_m = s_m;
    if (std::isinf(block_.possible_m) && !check_.clear_of(pose, false)) block_.possible_m = s_m;
    if (look_for_unseen && std::isinf(block_.unseen_m) && !check_.all_unseen(pose, [](Point2) { return false; }))
      block_.unseen_m = s_m;
  }

  const BlockQuery& query_;
  FootprintCheck check_;
  Block block_;
};

}  // namespace

Block find_block(const BlockQuery& query) {
  return BlockFinder(query).run();
}

}  // namespace rover::planning
