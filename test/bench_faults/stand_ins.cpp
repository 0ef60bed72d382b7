#include "test/bench_faults/stand_ins.hpp"

#include <rover/disparity_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/vo_motion_t.hpp>

#include "common/bus/convert.hpp"

namespace rover::bench_faults {
namespace {

constexpr Utime kExposurePeriodUs = 400'000;
constexpr Utime kTerrainPeriodUs = 1'000'000;
constexpr Utime kDisparityLatencyUs = 160'000;  // HAZARDS then are 0.24 s late, as on the whole rover
constexpr Utime kVisualLatencyUs = 220'000;
constexpr double kReachM = 6.0;
constexpr double kVisualSigmaM = 5e-4;
constexpr double kVisualSigmaRad = 3e-4;

double share_of(Blindness& blindness) {
  return blindness.share ? blindness.share(blindness.pictures++) : 1.0;
}

class VisualOdometry {
 public:
  VisualOdometry(Node& node, const StandInRover& rover, const Blindness& blindness)
      : node_(node), rover_(rover), blindness_(blindness) {
    node_.on_step([this](Utime now) { step(now); });
  }

 private:
  void step(Utime now) {
    if (now % kExposurePeriodUs != 0) return;
    const Eigen::Isometry3d T = rover_.T_map_body();
    if (previous_utime_ != kNever) publish(now, T);
    if (previous_utime_ != kNever && blindness_.visual_lost) return;
    previous_utime_ = now;
    T_previous_ = T;
  }

  void publish(Utime now, const Eigen::Isometry3d& T) {
    vo_motion_t out{};
    out.previous_utime = out.keyframe_utime = previous_utime_;
    out.status = blindness_.visual_lost ? vo_motion_t::LOST : vo_motion_t::OK;
    pose_to(blindness_.visual_lost ? nan_pose() : T_previous_.inverse() * T, out.position_m, out.quat_wxyz);
    Matrix6d cov = Matrix6d::Zero();
    cov.diagonal().head<3>().setConstant(kVisualSigmaM * kVisualSigmaM);
    cov.diagonal().tail<3>().setConstant(kVisualSigmaRad * kVisualSigmaRad);
    matrix6_to(blindness_.visual_lost ? nan_cov() : cov, out.covariance);
    out.features = out.inliers = 300;
    node_.publish(channel::kVo, out, now, kVisualLatencyUs);
  }

  Node& node_;
  const StandInRover& rover_;
  const Blindness& blindness_;
  Utime previous_utime_ = kNever;
  Eigen::Isometry3d T_previous_ = Eigen::Isometry3d::Identity();
};

}  // namespace

std::shared_ptr<void> make_stereo(Node& node, const StandInRover& rover, Field& field, const View& view,
                                  Blindness& blindness) {
  node.on_step([&](Utime now) {
    if (now % kExposurePeriodUs != 0) return;
    disparity_t out{};
    disparity_to(view.look(field.around(rover.pose(), kReachM), share_of(blindness)), view.camera(), out);
    node.publish(channel::kDisparity, out, now, kDisparityLatencyUs);
  });
  return nullptr;
}

std::shared_ptr<void> make_visual_odometry(Node& node, const StandInRover& rover, const Blindness& blindness) {
  return std::make_shared<VisualOdometry>(node, rover, blindness);
}

std::shared_ptr<void> make_traversability(Node& node) {
  node.on_step([&node](Utime now) {
    if (now % kTerrainPeriodUs != 0) return;
    traversability_t out{};
    out.cells.assign(1, 0);
    out.size = 1;
    out.cells_x = out.cells_y = 1;
    out.difficulty = 0.5;
    node.publish(channel::kTraversability, out, now);
  });
  return nullptr;
}

std::shared_ptr<void> make_silent(Node&) {
  return nullptr;
}

}  // namespace rover::bench_faults
