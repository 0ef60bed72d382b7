// The two streams of a stereo camera as pairs: by exposure, of the rig's size, and told whether a camera has looked.
#pragma once

#include <functional>
#include <rover/image_t.hpp>
#include <string>

#include "common/bus/node.hpp"
#include "common/core/image.hpp"

namespace rover {

struct ImagePair {
  Utime utime = kNever;
  GrayImage left;
  GrayImage right;
  float left_exposure_s = 0.0F;
  float right_exposure_s = 0.0F;
  // A picture is to the last bit the one of the pair before. Noise never repeats, so that camera has not looked, and
  // what has moved would be taken for standing.
  bool frozen = false;
};

class ImagePairs {
 public:
  struct Source {
    std::string left_channel;
    std::string right_channel;
    int width = 0;
    int height = 0;
    Utime latency = 0;  // of the work on a pair
  };
  // Subscribes; images that contradict the size or have no partner of the same utime are rejected.
  ImagePairs(Node& node, const Source& source, std::function<void(const ImagePair&)> handler);
  ImagePairs(const ImagePairs&) = delete;
  ImagePairs& operator=(const ImagePairs&) = delete;

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
  void complete(Utime utime);

  Node& node_;
  int width_;
  int height_;
  std::function<void(const ImagePair&)> handler_;
  Slot left_;
  Slot right_;
};

}  // namespace rover
