// Pairs the two streams of a stereo camera by exposure time, checks their size, and detects a frozen camera.
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
  // An image equals the previous one bit by bit. Sensor noise never repeats, so the camera is frozen.
  bool frozen = false;
};

class ImagePairs {
 public:
  struct Source {
    std::string left_channel;
    std::string right_channel;
    int width = 0;
    int height = 0;
    Utime latency = 0;  // of processing a pair
  };
  // Subscribes. Images of another size, or without a partner of the same utime, are rejected.
  ImagePairs(Node& node, const Source& source, std::function<void(const ImagePair&)> handler);
  ImagePairs(const ImagePairs&) = delete;
  ImagePairs& operator=(const ImagePairs&) = delete;

 private:
  // An image that waits for its partner.
  struct Slot {
    std::string channel;
    Utime utime = kNever;  // kNever: empty
    GrayImage image;
    GrayImage previous;
    float exposure_s = 0.0F;
  };

  void add_image(Slot& own, Slot& other, const image_t& message);
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
