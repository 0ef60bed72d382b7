#include "common/bus/image_pairs.hpp"

#include "common/bus/convert.hpp"

namespace rover {

ImagePairs::ImagePairs(Node& node, const Source& source, std::function<void(const ImagePair&)> handler)
    : node_(node),
      width_(source.width),
      height_(source.height),
      handler_(std::move(handler)),
      left_{source.left_channel},
      right_{source.right_channel} {
  node_.subscribe_slow<image_t>(left_.channel, source.latency,
                                [this](const image_t& message) { add_image(left_, right_, message); });
  node_.subscribe_slow<image_t>(right_.channel, source.latency,
                                [this](const image_t& message) { add_image(right_, left_, message); });
}

void ImagePairs::add_image(Slot& own, Slot& other, const image_t& message) {
  GrayImage image = image_from(message);
  if (image.width != width_ || image.height != height_) {
    node_.reject(own.channel, "size or encoding is not the rig's");
    return;
  }
  drop_unpaired(own);
  own.utime = message.header.utime;
  own.exposure_s = message.exposure_s;
  own.image = std::move(image);
  if (other.utime < own.utime) drop_unpaired(other);
  if (other.utime == own.utime) complete(own.utime);
}

void ImagePairs::drop_unpaired(Slot& slot) {
  if (slot.utime == kNever) return;
  node_.reject(slot.channel, "no partner of the same utime");
  slot.utime = kNever;
}

void ImagePairs::complete(Utime utime) {
  ImagePair pair{utime, std::move(left_.image), std::move(right_.image), left_.exposure_s, right_.exposure_s};
  pair.frozen = pair.left.data == left_.previous.data || pair.right.data == right_.previous.data;
  handler_(pair);
  left_.utime = right_.utime = kNever;
  left_.previous = std::move(pair.left);
  right_.previous = std::move(pair.right);
}

}  // namespace rover
