// The bus side of the point cloud: a CLOUD for each NavCam pair that was exposed while the pan-tilt unit stood.
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
  void take(const ptu_state_t& state);
  void take(const ImagePair& pair);
  // Null where there is none near the time.
  const ptu_state_t* state_at(Utime utime) const;
  std::string refusal(const ImagePair& pair, const ptu_state_t* state) const;
  void report(const std::string& trouble);

  Node& node_;
  PanTiltUnit unit_;
  PointCloud core_;
  ImagePairs pairs_;
  std::deque<ptu_state_t> states_;  // of the last seconds
  std::string trouble_;             // empty: none
};

std::shared_ptr<PointCloudNode> make_point_cloud(Node& node, const std::string& config_dir);

}  // namespace rover::cloud
