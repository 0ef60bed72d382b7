// The bus side of SLAM: CLOUD and POSE in, ELEVATION and SLAM_POSE out, while the supervisor's level is FULL.
#pragma once

#include <memory>
#include <rover/cloud_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <string>

#include "common/bus/kept_state.hpp"
#include "common/bus/node.hpp"
#include "slam/config.hpp"
#include "slam/pose_history.hpp"

namespace rover::slam {

// The way that POSE tells without fresh visual odometry in it.
class BlindWay {
 public:
  // So far, this POSE included.
  double add(const pose_t& pose);

 private:
  double way_m_ = 0.0;
  double travelled_m_ = kNaN;
};

class SlamNode {
 public:
  SlamNode(Node& node, const NodeConfig& config);
  SlamNode(const SlamNode&) = delete;
  SlamNode& operator=(const SlamNode&) = delete;

 private:
  void take_state(const supervisor_state_t& message);
  void take_pose(const pose_t& message);
  void take_cloud(const cloud_t& message);
  void refuse(const std::string& why);
  void publish(const SlamResult& result, Utime utime);
  void report(Status status);

  Node& node_;
  KeptState kept_;
  Slam slam_;
  PoseHistory poses_;
  BlindWay blind_way_;
  bool full_ = false;
  bool unsaved_ = false;  // the checkpoint is older than the newest cloud
  Status last_ = Status::kOk;
};

std::shared_ptr<SlamNode> make_slam(Node& node, const std::string& config_dir);

}  // namespace rover::slam
