// The bus side of stereo: pairs the LocCam images by their time and publishes what the core makes of them.
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
  void report(const std::string& trouble, double valid_fraction);

  Node& node_;
  Stereo core_;
  ImagePairs pairs_;
  std::string trouble_;  // empty: none
};

std::shared_ptr<StereoNode> make_stereo(Node& node, const std::string& config_dir);

}  // namespace rover::stereo
