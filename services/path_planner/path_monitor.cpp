#include "path_planner/path_monitor.hpp"

namespace rover::planning {
namespace {

constexpr double kStepM = 0.05;
constexpr double kTurnStepRad = 0.0524;
constexpr double kMonitorApproachM = 0.025;  // a path is not its plan to the millimetre

class Monitor {
 public:
  explicit Monitor(const MonitorQuery& query)
      : query_(query),
        motion_(query.route, query.from_m, query.rover, query.side_slip, query.turning),
        check_(query.costmap, query.footprint, query.margin_m, kMonitorApproachM, 0.0, query.rover, query.planned_from),
        roll_(query.roll, query.costmap, query.footprint, query.planned_from, RollCosts::kToleranceRad),
        visibility_(query.costmap, check_, query.view) {}

  Blockage run() {
    const double turn_rad = wrap_angle(motion_.on_route(query_.from_m).yaw_rad - query_.rover.yaw_rad);
    if (query_.turning) check_turn(query_.rover, turn_rad, query_.from_m);
    // A point turn shows the ground ahead; until then nothing can be said of it.
    bool view_known = !query_.turning;
    size_t corner = 0;
    double next_view_m = query_.from_m + kViewStepM;  // from here the LocCam has seen what there is to see
    const std::vector<size_t>& corners = query_.route.corners();
    for (double s = query_.from_m; s <= query_.route.length_m() && !complete(); s += kStepM) {
      for (; corner < corners.size() && query_.route.s_at(corners[corner]) < s; ++corner)
        if (query_.route.s_at(corners[corner]) > query_.from_m) {
          check_corner(corners[corner], s);
          view_known = false;
        }
      const Pose2 pose = motion_.at(s);
      if (!query_.costmap.contains(position(pose))) break;
      check(pose, s, view_known);
      if (s < next_view_m) continue;
      visibility_.add_view(pose);
      next_view_m += kViewStepM;
    }
    return blockage_;
  }

 private:
  bool complete() const { return std::isfinite(blockage_.hazard_m) && std::isfinite(blockage_.unseen_m); }

  void check_corner(size_t i, double s_m) {
    const Point2 p = query_.route.points()[i].p;
    const double yaw_rad = query_.route.yaw_into(i);
    check_turn({p.x_m, p.y_m, yaw_rad}, wrap_angle(query_.route.yaw_out_of(i) - yaw_rad), s_m);
  }

  void check_turn(Pose2 pose, double turn_rad, double s_m) {
    const int steps = 1 + static_cast<int>(std::abs(turn_rad) / kTurnStepRad);
    for (int i = 0; i <= steps; ++i) {
      check(pose, s_m, true);
      pose.yaw_rad += turn_rad / steps;
    }
  }

  void check(const Pose2& pose, double s_m, bool check_unknown) {
    if (std::isinf(blockage_.hazard_m) && !(check_.clear(pose) && roll_.allows(pose))) blockage_.hazard_m = s_m;
    if (!check_unknown || std::isfinite(blockage_.unseen_m) || check_.known(pose)) return;
    blockage_.unknown_m = std::min(blockage_.unknown_m, s_m);
    if (!visibility_.covers(pose)) blockage_.unseen_m = s_m;
  }

  const MonitorQuery& query_;
  ExpectedMotion motion_;
  FootprintCheck check_;
  RollCheck roll_;
  Visibility visibility_;
  Blockage blockage_;
};

}  // namespace

Blockage find_blockage(const MonitorQuery& query) {
  return Monitor(query).run();
}

}  // namespace rover::planning
