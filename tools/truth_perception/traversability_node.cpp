#include <cmath>
#include <map>
#include <optional>
#include <rover/cloud_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/convert.hpp"
#include "common/bus/elevation_message.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/stereo/rectifier.hpp"
#include "tools/truth_perception/nodes.hpp"
#include "tools/truth_perception/true_terrain.hpp"
#include "traversability/config.hpp"
#include "traversability/convert.hpp"
#include "traversability/difficulty.hpp"

namespace rover::truth {
namespace {

constexpr Utime kHistoryUs = 5'000'000;
constexpr Utime kPoseAgeUs = 100'000;  // at an exposure

// Values by measurement time.
template <class Value>
class History {
 public:
  void add(Utime utime, const Value& value) {
    values_[utime] = value;
    values_.erase(values_.begin(), values_.lower_bound(utime - kHistoryUs));
  }
  // The newest value of this time or before; null if it is older than that.
  const Value* at(Utime utime, Utime max_age) const {
    auto found = values_.upper_bound(utime);
    if (found == values_.begin()) return nullptr;
    --found;
    return utime - found->first > max_age ? nullptr : &found->second;
  }

 private:
  std::map<Utime, Value> values_;
};

// What allows for mean heights of cells is off: the highest point of a cell has no rim.
trav::NodeConfig for_true_heights(trav::NodeConfig config) {
  config.core.step.mean_height_ratio = config.core.step.rim_fraction = 1.0;
  return config;
}

// Optics of the rectified NavCam and the depths that point_cloud keeps.
View navcam_view(const std::string& config_dir) {
  const Config cloud = Config::load(config_dir + "/point_cloud.yaml");
  View view;
  view.camera = stereo::Rectifier(load_stereo_rig(config_dir, "navcam"), {}, std::nullopt).camera();
  view.min_depth_m = cloud.number("min_depth_m", {0.2, 20.0});
  view.max_depth_m = cloud.number("max_depth_m", {1.0, 30.0});
  return view;
}

class TraversabilityNode {
 public:
  TraversabilityNode(Node& node, const TruthPerception& perception, const trav::NodeConfig& config)
      : node_(node), surface_(perception.surface), config_(config), view_(navcam_view(perception.config_dir)) {
    node_.subscribe<truth_t>(channel::kTruth, [this](const truth_t& m) {
      truth_.add(m.header.utime, pose_from(m.position_map_body_m, m.quat_map_body_wxyz));
    });
    node_.subscribe<pose_t>(channel::kPose,
                            [this](const pose_t& m) { odometry_.add(m.header.utime, trav::body_from(m)); });
    node_.subscribe<cloud_t>(channel::kCloud, [this](const cloud_t& m) { on_cloud(m); });
    node_.subscribe_slow<elevation_t>(channel::kElevation, config_.latency_us,
                                      [this](const elevation_t& m) { on_elevation(m); });
  }

 private:
  void on_cloud(const cloud_t& message) {
    const Eigen::Isometry3d* T_map_body = truth_.at(message.header.utime, 0);
    if (T_map_body == nullptr) return node_.reject(channel::kCloud, "no TRUTH of its time");
    view_.T_map_cam = *T_map_body * pose_from(message.position_body_cam_m, message.quat_body_cam_wxyz);
    looks_.push_back(view_);
  }

  void on_elevation(const elevation_t& message) {
    if (const std::string fault = fault_of(message); !fault.empty()) return node_.reject(channel::kElevation, fault);
    const Eigen::Isometry3d* T_map_body = truth_.at(message.header.utime, 0);
    const Pose2* body_odom = odometry_.at(message.header.utime, kPoseAgeUs);
    if (T_map_body == nullptr || body_odom == nullptr || std::isnan(body_odom->yaw_rad))
      return node_.reject(channel::kElevation, "no TRUTH or POSE of its time");
    const trav::GridShape shape = trav::grid_from(message).shape;
    add_looks(shape);
    publish(terrain_->grid(shape, planar(*T_map_body), *body_odom), message.header.utime);
  }

  void add_looks(const trav::GridShape& shape) {
    if (!terrain_) terrain_.emplace(shape.cells_x, shape.cell_m, surface_);
    for (const View& look : looks_) terrain_->add(look);
    looks_.clear();
  }

  void publish(const trav::TerrainGrid& grid, Utime utime) {
    const Pose2* body = odometry_.at(node_.now(), to_utime(config_.max_pose_age_s));
    const trav::TraversabilityMap map = trav::compute_traversability(grid, config_.core);
    const double difficulty =
        trav::difficulty_ahead(map, body != nullptr ? *body : Pose2{kNaN, kNaN, kNaN}, config_.core.ahead);
    traversability_t out{};
    trav::traversability_to(map, difficulty, out);
    node_.publish(channel::kTraversability, out, utime);
  }

  Node& node_;
  std::shared_ptr<TrueSurface> surface_;
  trav::NodeConfig config_;
  View view_;
  History<Eigen::Isometry3d> truth_;  // T_map_body
  History<Pose2> odometry_;           // body in odom
  std::vector<View> looks_;           // since the last ELEVATION
  std::optional<TrueTerrain> terrain_;
};

}  // namespace

std::shared_ptr<void> make_truth_traversability(Node& node, const TruthPerception& perception) {
  return std::make_shared<TraversabilityNode>(node, perception,
                                              for_true_heights(trav::load_config(perception.config_dir)));
}

}  // namespace rover::truth
