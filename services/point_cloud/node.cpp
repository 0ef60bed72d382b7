#include "point_cloud/node.hpp"

#include <cstdlib>
#include <opencv2/core.hpp>
#include <rover/cloud_t.hpp>

#include "point_cloud/convert.hpp"

namespace rover::cloud {
namespace {

constexpr Utime kImageLatencyUs = 2'000'000;  // well above that of the camera
constexpr double kMinValidFraction = 0.02;    // of pixels with a disparity; less: DEGRADED

}  // namespace

PointCloudNode::PointCloudNode(Node& node, const NodeConfig& config)
    : node_(node),
      unit_(config.unit),
      core_(config.core, config.rig, config.unit, config.ground_below_m),
      state_history_us_(kImageLatencyUs + node.scaled(config.latency_us)),
      pairs_(node,
             {channel::kNavCamLeft, channel::kNavCamRight, config.rig.width, config.rig.height, config.latency_us},
             [this](const ImagePair& pair) { on_pair(pair); }) {
  cv::setNumThreads(1);
  node_.subscribe<ptu_state_t>(channel::kPtuState, [this](const ptu_state_t& state) { on_ptu_state(state); });
}

void PointCloudNode::on_ptu_state(const ptu_state_t& state) {
  if (const std::string fault = fault_of(state, unit_); !fault.empty()) return node_.reject(channel::kPtuState, fault);
  states_.push_back(state);
  while (states_.front().header.utime < state.header.utime - state_history_us_) states_.pop_front();
}

void PointCloudNode::on_pair(const ImagePair& pair) {
  const ptu_state_t* state = state_at(pair.utime);
  if (const std::string reason = rejection(pair, state); !reason.empty()) {
    node_.reject(channel::kNavCamLeft, reason);
    return report_status(reason);
  }
  const auto result = core_.step(pair.left, pair.right, state->pan_rad, state->tilt_rad, pair.left_exposure_s);
  if (!result) return;
  cloud_t cloud{};
  cloud_to(*result, cloud);
  node_.publish(channel::kCloud, cloud, pair.utime);
  report_status(result->valid_fraction < kMinValidFraction ? "no stereo" : "");
}

const ptu_state_t* PointCloudNode::state_at(Utime utime) const {
  const ptu_state_t* nearest = nullptr;
  const auto distance = [utime](const ptu_state_t& state) { return std::llabs(state.header.utime - utime); };
  for (const ptu_state_t& state : states_)
    if (distance(state) <= kTickUs && (nearest == nullptr || distance(state) < distance(*nearest))) nearest = &state;
  return nearest;
}

std::string PointCloudNode::rejection(const ImagePair& pair, const ptu_state_t* state) const {
  if (pair.frozen) return "camera frozen";
  if (state == nullptr) return "no PTU_STATE of the exposure";
  return state->moving != 0 ? "exposed while the unit moved" : "";
}

void PointCloudNode::report_status(const std::string& problem) {
  if (problem == problem_) return;
  problem_ = problem;
  node_.set_status(problem.empty() ? heartbeat_t::OK : heartbeat_t::DEGRADED, problem);
  node_.log(problem.empty() ? "INFO" : "WARN", problem.empty() ? "CLOUD_BACK" : "NO_CLOUD why=" + problem);
}

std::shared_ptr<PointCloudNode> make_point_cloud(Node& node, const std::string& config_dir) {
  return std::make_shared<PointCloudNode>(node, load_config(config_dir));
}

}  // namespace rover::cloud
