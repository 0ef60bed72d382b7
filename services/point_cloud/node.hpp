// Bus node: one CLOUD per NavCam pair that was exposed while the pan-tilt unit was stationary.
#pragma once

#include <deque>
#include <memory>
#include <rover/ptu_state_t.hpp>
#include <string>

#include "common/bus/image_pairs.hpp"
#include "point_cloud/config.hpp"

namespace rover::cloud {

class PointCloudNode {
 public:
  PointCloudNode(Node& node, const NodeConfig& config);
  PointCloudNode(const PointCloudNode&) = delete;
  PointCloudNode& operator=(const PointCloudNode&) = delete;

 private:
  void on_ptu_state(const ptu_state_t& state);
  void on_pair(const ImagePair& pair);
  // Nearest state; null if none is within a tick.
  const ptu_state_t* state_at(Utime utime) const;
  std::string rejection(const ImagePair& pair, const ptu_state_t* state) const;
  void report_status(const std::string& problem);

  Node& node_;
  PanTiltUnit unit_;
  PointCloud core_;
  Utime state_history_us_;  // a pair may wait until the one before it is done
  ImagePairs pairs_;
  std::deque<ptu_state_t> states_;
  std::string problem_;  // empty: none
};

std::shared_ptr<PointCloudNode> make_point_cloud(Node& node, const std::string& config_dir);

}  // namespace rover::cloud
