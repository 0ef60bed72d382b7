// Pairs the LocCam images by exposure time; publishes the rectified pair and the disparity.
#pragma once

#include <memory>
#include <string>

#include "common/bus/image_pairs.hpp"
#include "stereo/config.hpp"

namespace rover::stereo {

class StereoNode {
 public:
  StereoNode(Node& node, const NodeConfig& config);
  StereoNode(const StereoNode&) = delete;
  StereoNode& operator=(const StereoNode&) = delete;

 private:
  void process(const ImagePair& pair);
  void report(const std::string& problem, double valid_fraction);

  Node& node_;
  Stereo core_;
  ImagePairs pairs_;
  std::string problem_;  // empty: healthy
};

std::shared_ptr<StereoNode> make_stereo(Node& node, const std::string& config_dir);

}  // namespace rover::stereo
