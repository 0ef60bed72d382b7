#include "test/bench_faults/stand_ins.hpp"

#include <cmath>
#include <rover/disparity_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/vo_motion_t.hpp>

#include "common/bus/convert.hpp"

namespace rover::bench_faults {
namespace {

constexpr Utime kExposurePeriodUs = 400'000;
constexpr Utime kTerrainPeriodUs = 1'000'000;
constexpr double kTerrainCellM = 0.1;
constexpr std::int16_t kTerrainCells = 200;
constexpr Utime kDisparityLatencyUs = 160'000;  // gives HAZARDS a latency of 0.24 s, as on the rover
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
    if (previous_utime_ != kNever && (blindness_.visual_lost || blindness_.displaced)) return;
    previous_utime_ = now;
    T_previous_ = T;
  }

  void publish(Utime now, const Eigen::Isometry3d& T) {
    vo_motion_t out{};
    const bool lost = blindness_.visual_lost || blindness_.displaced;
    out.previous_utime = out.keyframe_utime = previous_utime_;
    out.status = blindness_.displaced ? vo_motion_t::DISPLACED : lost ? vo_motion_t::LOST : vo_motion_t::OK;
    pose_to(lost ? nan_pose() : T_previous_.inverse() * T, out.position_m, out.quat_wxyz);
    Matrix6d cov = Matrix6d::Zero();
    cov.diagonal().head<3>().setConstant(kVisualSigmaM * kVisualSigmaM);
    cov.diagonal().tail<3>().setConstant(kVisualSigmaRad * kVisualSigmaRad);
    matrix6_to(lost ? nan_cov() : cov, out.covariance);
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

std::shared_ptr<void> make_slam(Node& node, const Blindness& blindness) {
  node.on_step([&node, &blindness](Utime now) {
    if (now % kTerrainPeriodUs != 0) return;
    slam_pose_t out{};
    out.status = blindness.slam_lost ? slam_pose_t::LOST : slam_pose_t::NO_INFORMATION;
    node.publish(channel::kSlamPose, out, now);
  });
  return nullptr;
}

std::shared_ptr<void> make_traversability(Node& node) {
  const auto at = std::make_shared<Eigen::Vector3d>(Eigen::Vector3d::Zero());
  node.subscribe<pose_t>(channel::kPose, [at](const pose_t& m) { *at = Eigen::Vector3d(m.position_odom_body_m); });
  node.on_step([&node, at](Utime now) {
    if (now % kTerrainPeriodUs != 0 || !at->allFinite()) return;
    traversability_t out{};
    out.cell_m = kTerrainCellM;
    out.cells_x = out.cells_y = kTerrainCells;
    out.size = kTerrainCells * kTerrainCells;
    out.cells.assign(static_cast<size_t>(out.size), traversability_t::FREE);
    out.step_percent.assign(static_cast<size_t>(out.size), 0);
    out.height_m.assign(static_cast<size_t>(out.size), 0.0F);
    // Cells are aligned to a fixed grid.
    const auto corner = [](double centre_m) {
      return kTerrainCellM * (std::floor(centre_m / kTerrainCellM) - kTerrainCells / 2);
    };
    out.origin_x_m = corner(at->x());
    out.origin_y_m = corner(at->y());
    out.difficulty = 0.5;
    node.publish(channel::kTraversability, out, now);
  });
  return at;
}

std::shared_ptr<void> make_silent(Node&) {
  return nullptr;
}

}  // namespace rover::bench_faults
