// Bus node of SLAM: CLOUD and POSE in, ELEVATION and SLAM_POSE out. Active only at the Full level.
#pragma once

#include <memory>
#include <rover/cloud_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <string>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/node.hpp"
#include "slam/config.hpp"
#include "slam/odometry_growth.hpp"
#include "slam/pose_history.hpp"

namespace rover::slam {

class SlamNode {
 public:
  SlamNode(Node& node, const NodeConfig& config);
  SlamNode(const SlamNode&) = delete;
  SlamNode& operator=(const SlamNode&) = delete;

 private:
  void on_state(const supervisor_state_t& message);
  void on_pose(const pose_t& message);
  void on_cloud(const cloud_t& message);
  void reject_cloud(const std::string& why);
  void publish(const SlamResult& result, Utime utime);
  void report_status(Status status);

  Node& node_;
  CheckpointStore checkpoint_;
  Slam slam_;
  PoseHistory poses_;
  OdometryGrowth growth_;
  bool full_level_ = false;
  bool unsaved_ = false;  // a cloud or a correction arrived since the last checkpoint
  Status last_status_ = Status::kOk;
};

std::shared_ptr<SlamNode> make_slam(Node& node, const std::string& config_dir);

}  // namespace rover::slam
