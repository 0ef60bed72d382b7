#include "tools/one_process/stand_ins.hpp"

#include <algorithm>
#include <rover/cloud_t.hpp>
#include <rover/disparity_t.hpp>
#include <rover/ptu_state_t.hpp>

#include "common/bus/convert.hpp"
#include "common/bus/vehicle_config.hpp"
#include "point_cloud/config.hpp"
#include "point_cloud/convert.hpp"
#include "rover_simulator/exposure_times.hpp"
#include "stereo/config.hpp"
#include "tools/one_process/motion_errors.hpp"
#include "visual_odometry/config.hpp"
#include "visual_odometry/convert.hpp"

namespace rover {
namespace {

constexpr Utime kStateHistory = 2'000'000;

class GeometricStereoNode {
 public:
  GeometricStereoNode(Node& node, const std::string& config_dir, GeometricPerception& perception)
      : node_(node),
        perception_(perception),
        config_(stereo::load_config(config_dir)),
        camera_(stereo::Stereo(config_.core, config_.rig, config_.origin_height_m).camera()),
        stereo_(config_.rig, perception.rover.true_loccam(), camera_, perception.view.scene()),
        errors_(errors_of(config_.core.matcher, camera_), camera_.width, camera_.height, perception.seed) {
    node.on_step([this](Utime now) {
      if (node_.busy()) return;
      if (const auto exposure = perception_.loccam.newest(now)) publish(*exposure);
    });
  }

 private:
  void publish(const Exposure& exposure) {
    node_.begin_slow(config_.latency_us);
    const DisparityPlane ground =
        config_.core.ground_reference ? ground_reference(camera_, config_.origin_height_m) : DisparityPlane{};
    const Disparity disparity = perception_.view.expose(stereo_, errors_, ground, exposure.T_map_left, exposure.utime);
    disparity_t message{};
    disparity_to(disparity, camera_, message);
    node_.publish(channel::kDisparity, message, exposure.utime);
  }

  Node& node_;
  GeometricPerception& perception_;
  stereo::NodeConfig config_;
  StereoCamera camera_;
  GeometricStereo stereo_;
  DisparityErrors errors_;
};

class GeometricOdometryNode {
 public:
  GeometricOdometryNode(Node& node, const std::string& config_dir, GeometricPerception& perception)
      : node_(node),
        perception_(perception),
        T_left_body_(load_stereo_rig(config_dir, "loccam").T_body_left.inverse()),
        stereo_latency_(stereo::load_config(config_dir).latency_us),
        latency_(to_utime(vo::load_config(config_dir).latency_s)),
        errors_(perception.seed) {
    node.on_step([this](Utime now) {
      if (node_.busy()) return;
      if (const auto exposure = perception_.loccam_motion.newest(now)) publish(*exposure);
    });
  }

 private:
  void publish(const Exposure& exposure) {
    node_.begin_slow(std::max(stereo_latency_, latency_));  // stereo works on the next pair meanwhile
    const auto result = errors_.step(exposure.utime, exposure.T_map_left * T_left_body_);
    if (!result) return;
    vo_motion_t message{};
    vo::motion_to(*result, message);
    node_.publish(channel::kVo, message, exposure.utime, node_.scaled(stereo_latency_ + latency_) - kTickUs);
  }

  Node& node_;
  GeometricPerception& perception_;
  Eigen::Isometry3d T_left_body_;
  Utime stereo_latency_;
  Utime latency_;
  MotionErrors errors_;
};

class GeometricCloudNode {
 public:
  GeometricCloudNode(Node& node, const std::string& config_dir, GeometricPerception& perception)
      : node_(node),
        perception_(perception),
        config_(cloud::load_config(config_dir)),
        core_(config_.core, config_.rig, config_.unit, config_.ground_below_m),
        stereo_(config_.rig, perception.rover.true_navcam(), core_.camera_at(0.0), perception.view.scene()),
        errors_(errors_of(config_.core.matcher, core_.camera_at(0.0)), core_.width(), core_.height(),
                perception.seed + 1) {
    node.subscribe<ptu_state_t>(channel::kPtuState, [this](const ptu_state_t& state) {
      if (const std::string fault = cloud::fault_of(state, config_.unit); !fault.empty())
        return node_.reject(channel::kPtuState, fault);
      states_.push_back(state);
      while (states_.front().header.utime < state.header.utime - kStateHistory) states_.pop_front();
    });
    node.on_step([this](Utime now) {
      if (node_.busy()) return;
      if (const auto exposure = perception_.navcam.newest(now)) publish(*exposure);
    });
  }

 private:
  void publish(const Exposure& exposure) {
    const auto state = std::find_if(states_.begin(), states_.end(), [&](const ptu_state_t& candidate) {
      return candidate.header.utime == exposure.utime;
    });
    if (state == states_.end()) return node_.reject(channel::kNavCamLeft, "no PTU_STATE of the exposure");
    if (state->moving != 0) return node_.reject(channel::kNavCamLeft, "exposed while the unit moved");
    node_.begin_slow(config_.latency_us);
    const DisparityPlane ground = ground_reference(core_.camera_at(state->tilt_rad), config_.ground_below_m);
    const auto result =
        core_.from_disparity(perception_.view.expose(stereo_, errors_, ground, exposure.T_map_left, exposure.utime),
                             state->pan_rad, state->tilt_rad);
    cloud_t message{};
    cloud::cloud_to(result, message);
    node_.publish(channel::kCloud, message, exposure.utime);
  }

  Node& node_;
  GeometricPerception& perception_;
  cloud::NodeConfig config_;
  cloud::PointCloud core_;
  GeometricStereo stereo_;
  DisparityErrors errors_;
  std::deque<ptu_state_t> states_;  // of the last seconds
};

}  // namespace

std::optional<Exposure> Exposures::newest(Utime now) {
  std::optional<Exposure> exposure;
  while (!waiting_.empty() && waiting_.front().utime + kCameraLatency <= now) {
    exposure = waiting_.front();
    waiting_.pop_front();
  }
  return exposure;
}

std::shared_ptr<void> make_geometric_stereo(Node& node, const std::string& config_dir,
                                            GeometricPerception& perception) {
  return std::make_shared<GeometricStereoNode>(node, config_dir, perception);
}

std::shared_ptr<void> make_geometric_odometry(Node& node, const std::string& config_dir,
                                              GeometricPerception& perception) {
  return std::make_shared<GeometricOdometryNode>(node, config_dir, perception);
}

std::shared_ptr<void> make_geometric_cloud(Node& node, const std::string& config_dir, GeometricPerception& perception) {
  return std::make_shared<GeometricCloudNode>(node, config_dir, perception);
}

}  // namespace rover
