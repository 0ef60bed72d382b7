// Where the body will be on its way along a route: its tracking error vanishes, and on a side slope it points uphill of
// the route.
#pragma once

#include "path_planner/route.hpp"
#include "path_planner/side_slip.hpp"

namespace rover::planning {

class ExpectedMotion {
 public:
  // `from_m`: where the rover is along the route. One that turns on the spot keeps no heading error.
  ExpectedMotion(const Route& route, double from_m, const Pose2& rover, const SideSlip& side_slip, bool turning)
      : route_(route), from_m_(from_m), side_slip_(side_slip) {
    const Pose2 here = on_route(from_m);
    error_ = {rover.x_m - here.x_m, rover.y_m - here.y_m, turning ? 0.0 : wrap_angle(rover.yaw_rad - here.yaw_rad)};
  }

  Pose2 on_route(double s_m) const {
    Pose2 pose = route_.pose_at(s_m);
    pose.yaw_rad = side_slip_.heading(pose.yaw_rad, route_.reverse_at(s_m));
    return pose;
  }
  Pose2 at(double s_m) const { return shifted(on_route(s_m), s_m); }
  // By what remains of the tracking error there.
  Pose2 shifted(const Pose2& pose, double s_m) const {
    const double remaining = std::clamp(1.0 - (s_m - from_m_) / kMergeM, 0.0, 1.0);
    return {pose.x_m + remaining * error_.x_m, pose.y_m + remaining * error_.y_m,
            pose.yaw_rad + remaining * error_.yaw_rad};
  }

 private:
  static constexpr double kMergeM = 1.0;  // over about this distance the controller removes a cross-track error

  const Route& route_;
  double from_m_;
  SideSlip side_slip_;
  Pose2 error_;
};

}  // namespace rover::planning
