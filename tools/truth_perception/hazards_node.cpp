#include <rover/hazards_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/convert.hpp"
#include "hazard_detector/config.hpp"
#include "hazard_detector/convert.hpp"
#include "rover_simulator/exposure_times.hpp"
#include "stereo/config.hpp"
#include "tools/truth_perception/nodes.hpp"
#include "tools/truth_perception/true_hazards.hpp"

namespace rover::truth {
namespace {

class HazardsNode {
 public:
  HazardsNode(Node& node, const TruthPerception& perception, const hazard::NodeConfig& config,
              const stereo::NodeConfig& stereo)
      : node_(node),
        extra_latency_us_(kCameraLatency + node.scaled(stereo.latency_us + config.latency_us) - kTickUs),
        hazards_(config.core, stereo::Stereo(stereo.core, stereo.rig, stereo.origin_height_m).camera(),
                 perception.surface) {
    node_.subscribe<truth_t>(channel::kTruth, [this](const truth_t& message) { on_truth(message); });
  }

 private:
  void on_truth(const truth_t& message) {
    const Utime utime = message.header.utime;
    if (utime < kFirstTick || (utime - kFirstTick) % kLocCamPeriod != 0) return;
    hazards_t out{};
    const hazard::HazardResult result =
        hazards_.step(pose_from(message.position_map_body_m, message.quat_map_body_wxyz));
    hazard::hazards_to(result, hazards_.shape(), out);
    node_.publish(channel::kHazards, out, utime, extra_latency_us_);
  }

  Node& node_;
  Utime extra_latency_us_;
  TrueHazards hazards_;
};

}  // namespace

std::shared_ptr<void> make_truth_hazards(Node& node, const TruthPerception& perception) {
  return std::make_shared<HazardsNode>(node, perception, hazard::load_config(perception.config_dir),
                                       stereo::load_config(perception.config_dir));
}

}  // namespace rover::truth
