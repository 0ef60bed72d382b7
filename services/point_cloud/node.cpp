#include "point_cloud/node.hpp"

#include <cstdlib>
#include <opencv2/core.hpp>
#include <rover/cloud_t.hpp>

#include "point_cloud/convert.hpp"

namespace rover::cloud {
namespace {

constexpr Utime kKeep = 2'000'000;       // pictures come well within it
constexpr double kBlindFraction = 0.02;  // less stereo than this is worth a word in the heartbeat

}  // namespace

PointCloudNode::PointCloudNode(Node& node, const NodeConfig& config)
    : node_(node),
      unit_(config.unit),
      core_(config.core, config.rig, config.unit, config.ground_below_m),
      pairs_(node,
             {channel::kNavCamLeft, channel::kNavCamRight, config.rig.width, config.rig.height, config.latency_us},
             [this](const ImagePair& pair) { take(pair); }) {
  cv::setNumThreads(1);
  node_.subscribe<ptu_state_t>(channel::kPtuState, [this](const ptu_state_t& state) { take(state); });
}

void PointCloudNode::take(const ptu_state_t& state) {
  if (const std::string fault = fault_of(state, unit_); !fault.empty()) return node_.reject(channel::kPtuState, fault);
  states_.push_back(state);
  while (states_.front().header.utime < state.header.utime - kKeep) states_.pop_front();
}

void PointCloudNode::take(const ImagePair& pair) {
  const ptu_state_t* state = state_at(pair.utime);
  if (const std::string why = refusal(pair, state); !why.empty()) {
    node_.reject(channel::kNavCamLeft, why);
    return report(why);
  }
  const auto result = core_.step(pair.left, pair.right, state->pan_rad, state->tilt_rad);
  if (!result) return;
  cloud_t cloud{};
  cloud_to(*result, cloud);
  node_.publish(channel::kCloud, cloud, pair.utime);
  report(result->valid_fraction < kBlindFraction ? "no stereo" : "");
}

const ptu_state_t* PointCloudNode::state_at(Utime utime) const {
  const ptu_state_t* nearest = nullptr;
  const auto distance = [utime](const ptu_state_t& state) { return std::llabs(state.header.utime - utime); };
  for (const ptu_state_t& state : states_)
    if (distance(state) <= kTickUs && (nearest == nullptr || distance(state) < distance(*nearest))) nearest = &state;
  return nearest;
}

std::string PointCloudNode::refusal(const ImagePair& pair, const ptu_state_t* state) const {
  if (pair.frozen) return "camera frozen";
  if (state == nullptr) return "no PTU_STATE of the exposure";
  return state->moving != 0 ? "exposed while the unit moved" : "";
}

void PointCloudNode::report(const std::string& trouble) {
  if (trouble == trouble_) return;
  trouble_ = trouble;
  node_.set_status(trouble.empty() ? heartbeat_t::OK : heartbeat_t::DEGRADED, trouble);
  node_.log(trouble.empty() ? "INFO" : "WARN", trouble.empty() ? "CLOUD_BACK" : "NO_CLOUD why=" + trouble);
}

std::shared_ptr<PointCloudNode> make_point_cloud(Node& node, const std::string& config_dir) {
  return std::make_shared<PointCloudNode>(node, load_config(config_dir));
}

}  // namespace rover::cloud
