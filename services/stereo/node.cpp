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
  auto result = core_.step(left_.image, right_.image);
  const bool left_frozen = retire(left_);
  const bool frozen = retire(right_) || left_frozen;
  if (!result) return;
  if (frozen) result->disparity = Disparity(result->disparity.width, result->disparity.height);
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
  report(frozen                                      ? "camera frozen"
         : disparity.valid_fraction < kBlindFraction ? "no stereo"
                                                     : "",
         disparity.valid_fraction);
}

// The pair is done with. True where the picture is the one before again: noise never repeats, so that camera has not
// looked, and motion of the rover would be taken for standing.
bool StereoNode::retire(Slot& slot) {
  const bool again = slot.image.data == slot.before.data;
  slot.utime = kNever;
  slot.before = std::move(slot.image);
  return again;
}

void StereoNode::report(const std::string& trouble, double valid_fraction) {
  if (trouble == trouble_) return;
  trouble_ = trouble;
  const std::string figure = " valid_fraction=" + std::to_string(valid_fraction);
  node_.set_status(trouble.empty() ? heartbeat_t::OK : heartbeat_t::DEGRADED, trouble);
  if (trouble.empty())
    node_.log("INFO", "STEREO_BACK" + figure);
  else
    node_.log("WARN", "NO_STEREO why=" + trouble + figure);
}

std::shared_ptr<StereoNode> make_stereo(Node& node, const std::string& config_dir) {
  return std::make_shared<StereoNode>(node, load_config(config_dir));
}

}  // namespace rover::stereo
