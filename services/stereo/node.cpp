#include "stereo/node.hpp"

#include <opencv2/core.hpp>
#include <rover/disparity_t.hpp>

#include "common/bus/convert.hpp"

namespace rover::stereo {
namespace {

constexpr double kBlindFraction = 0.02;  // less valid stereo than this is worth a word in the heartbeat

}  // namespace

StereoNode::StereoNode(Node& node, const NodeConfig& config)
    : node_(node),
      core_(config.core, config.rig, config.ground_below_m),
      left_{channel::kLocCamLeft},
      right_{channel::kLocCamRight} {
  cv::setNumThreads(1);
  node_.subscribe_slow<image_t>(left_.channel, config.latency_us,
                                [this](const image_t& message) { take(left_, right_, message); });
  node_.subscribe_slow<image_t>(right_.channel, config.latency_us,
                                [this](const image_t& message) { take(right_, left_, message); });
}

void StereoNode::take(Slot& own, Slot& other, const image_t& message) {
  GrayImage image = image_from(message);
  if (image.width != core_.camera().width || image.height != core_.camera().height) {
    node_.reject(own.channel, "size or encoding is not the rig's");
    return;
  }
  drop_unpaired(own);
  own.utime = message.header.utime;
  own.exposure_s = message.exposure_s;
  own.image = std::move(image);
  if (other.utime < own.utime) drop_unpaired(other);
  if (other.utime == own.utime) process(own.utime);
}

void StereoNode::drop_unpaired(Slot& slot) {
  if (slot.utime == kNever) return;
  node_.reject(slot.channel, "no partner of the same utime");
  slot.utime = kNever;
}

void StereoNode::process(Utime utime) {
  const auto result = core_.step(left_.image, right_.image);
  left_.utime = right_.utime = kNever;
  if (!result) return;
  image_t image{};
  image.exposure_s = left_.exposure_s;
  image_to(result->left, image);
  node_.publish(channel::kLocCamRectLeft, image, utime);
  image.exposure_s = right_.exposure_s;
  image_to(result->right, image);
  node_.publish(channel::kLocCamRectRight, image, utime);
  disparity_t disparity{};
  disparity_to(result->disparity, core_.camera(), disparity);
  node_.publish(channel::kDisparity, disparity, utime);
  report(disparity.valid_fraction);
}

void StereoNode::report(double valid_fraction) {
  const bool blind = valid_fraction < kBlindFraction;
  if (blind == blind_) return;
  blind_ = blind;
  node_.set_status(blind ? heartbeat_t::DEGRADED : heartbeat_t::OK, blind ? "no stereo" : "");
  node_.log(blind ? "WARN" : "INFO",
            (blind ? "NO_STEREO valid_fraction=" : "STEREO_BACK valid_fraction=") + std::to_string(valid_fraction));
}

std::shared_ptr<StereoNode> make_stereo(Node& node, const std::string& config_dir) {
  return std::make_shared<StereoNode>(node, load_config(config_dir));
}

}  // namespace rover::stereo
