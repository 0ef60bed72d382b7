// The bus side of stereo: pairs the LocCam images by their time and publishes what the core makes of them.
#pragma once

#include <memory>
#include <rover/image_t.hpp>
#include <string>

#include "common/bus/node.hpp"
#include "stereo/config.hpp"

namespace rover::stereo {

class StereoNode {
 public:
  StereoNode(Node& node, const NodeConfig& config);
  StereoNode(const StereoNode&) = delete;
  StereoNode& operator=(const StereoNode&) = delete;

 private:
  // An image that waits for its partner.
  struct Slot {
    std::string channel;
    Utime utime = kNever;  // kNever: empty
    GrayImage image;
    GrayImage before;  // of the last pair
    float exposure_s = 0.0F;
  };

  void take(Slot& own, Slot& other, const image_t& message);
  void drop_unpaired(Slot& slot);
  void process(Utime utime);
  bool retire(Slot& slot);
  void report(const std::string& trouble, double valid_fraction);

  Node& node_;
  Stereo core_;
  Slot left_;
  Slot right_;
  std::string trouble_;  // empty: none
};

std::shared_ptr<StereoNode> make_stereo(Node& node, const std::string& config_dir);

}  // namespace rover::stereo
