#include "stereo/node.hpp"

#include <opencv2/core.hpp>
#include <rover/disparity_t.hpp>

#include "common/bus/convert.hpp"

namespace rover::stereo {
namespace {

constexpr double kMinValidFraction = 0.02;  // DEGRADED below this fraction of valid pixels

}  // namespace

StereoNode::StereoNode(Node& node, const NodeConfig& config)
    : node_(node),
      core_(config.core, config.rig, config.origin_height_m),
      pairs_(
          node,
          {channel::kLocCamLeft, channel::kLocCamRight, core_.camera().width, core_.camera().height, config.latency_us},
          [this](const ImagePair& pair) { process(pair); }) {
  cv::setNumThreads(1);
}

void StereoNode::process(const ImagePair& pair) {
  auto result = core_.step(pair.left, pair.right);
  if (!result) return;
  if (pair.frozen) {
    // No images: visual odometry would see a stationary rover in them. Its next motion spans the gap.
    result->disparity = Disparity(result->disparity.width, result->disparity.height);
  } else {
    image_t image{};
    image.exposure_s = pair.left_exposure_s;
    image_to(result->left, image);
    node_.publish(channel::kLocCamRectLeft, image, pair.utime);
    image.exposure_s = pair.right_exposure_s;
    image_to(result->right, image);
    node_.publish(channel::kLocCamRectRight, image, pair.utime);
  }
  disparity_t disparity{};
  disparity_to(result->disparity, core_.camera(), disparity);
  node_.publish(channel::kDisparity, disparity, pair.utime);
  report(pair.frozen                                    ? "camera frozen"
         : disparity.valid_fraction < kMinValidFraction ? "no stereo"
                                                        : "",
         disparity.valid_fraction);
}

void StereoNode::report(const std::string& problem, double valid_fraction) {
  if (problem == problem_) return;
  problem_ = problem;
  const std::string figure = " valid_fraction=" + std::to_string(valid_fraction);
  node_.set_status(problem.empty() ? heartbeat_t::OK : heartbeat_t::DEGRADED, problem);
  if (problem.empty())
    node_.log("INFO", "STEREO_BACK" + figure);
  else
    node_.log("WARN", "NO_STEREO why=" + problem + figure);
}

std::shared_ptr<StereoNode> make_stereo(Node& node, const std::string& config_dir) {
  return std::make_shared<StereoNode>(node, load_config(config_dir));
}

}  // namespace rover::stereo
