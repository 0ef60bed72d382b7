#include "global_localization/node.hpp"

#include <cmath>
#include <cstdio>
#include <rover/correction_t.hpp>
#include <rover/ground_command_t.hpp>

#include "common/bus/elevation_message.hpp"
#include "common/geo/elevation_map.hpp"
#include "global_localization/convert.hpp"
#include "global_localization/orbital_map_file.hpp"

namespace rover::global {
namespace {

constexpr Utime kTakenOverUs = 10 * kTickUs;  // POSE has a start pose by then

}  // namespace

GlobalLocalizationNode::GlobalLocalizationNode(Node& node, const NodeConfig& config)
    : node_(node), config_(config), schedule_(config.attempts) {
  pose_.header.utime = kNever;
  load_map();
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& message) {
    full_ = message.level == supervisor_state_t::FULL;
  });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& message) { pose_ = message; });
  node_.subscribe<ground_command_t>(channel::kGroundCommand, [this](const ground_command_t& message) {
    if (message.kind != ground_command_t::SET_START_POSE) return;
    start_pose_at_ = std::max(message.header.utime, node_.now()) + kTakenOverUs;
    searched_map_.reset();
  });
  node_.on_step([this](Utime) { search_at_start_pose(); });
  node_.subscribe_slow<elevation_t>(channel::kElevation, config.latency_us,
                                    [this](const elevation_t& message) { on_elevation(message); });
}

void GlobalLocalizationNode::load_map() {
  try {
    const std::string& dir = node_.options().run_dir;
    core_.emplace(config_.core, open_orbital_map(dir), config_.local_cell_m, load_picture(dir));
  } catch (const DtmError& error) {  // the rover can drive without an orbital map
    node_.set_status(heartbeat_t::DEGRADED, error.what());
    node_.log("WARN", std::string("NO_ORBITAL_MAP ") + error.what());
  }
}

// Relief does without it.
std::optional<OrbitalMap> GlobalLocalizationNode::load_picture(const std::string& run_dir) try {
  return open_orbital_picture(run_dir);
} catch (const DtmError& error) {
  node_.set_status(heartbeat_t::DEGRADED, error.what());
  node_.log("WARN", std::string("NO_ORBITAL_PICTURE ") + error.what());
  return std::nullopt;
}

void GlobalLocalizationNode::on_elevation(const elevation_t& message) {
  if (!full_) return;
  const std::string rejection = rejection_reason(message);
  if (!rejection.empty()) {
    node_.reject(channel::kElevation, rejection);
    return;
  }
  last_map_ = message.header.utime;
  const std::optional<Prior> prior = fresh_prior();
  if (!prior) return;
  check_for_odometry_jump(*prior);
  if (core_) core_->add_elevation(view_from(message), prior->p_odom_body);
  if (schedule_.due(pose_.travelled_m)) attempt_correction(*prior, message.header.utime);
}

// The rover is stationary then and no new maps come, so it searches at once; again with each map while they are too
// small. Where a drive begins there is no map yet, and no need, unless the rover is lost.
void GlobalLocalizationNode::search_at_start_pose() {
  if (start_pose_at_ == kNever || !full_ || node_.busy()) return;
  std::optional<Prior> prior = fresh_prior();
  if (!prior || pose_.header.utime <= start_pose_at_ || searched_map_ == last_map_) return;
  searched_map_ = last_map_;
  const bool lost = is_lost(config_.core.search, *prior);
  if (lost) prior->since_fix_m = kInfinity;  // the start pose owes nothing to the last fix
  bool settled = true;
  if (lost || last_map_ != kNever) {
    node_.begin_slow(config_.latency_us);
    settled = attempt_correction(*prior, pose_.header.utime).reason != kMapTooSmall;
  }
  if (settled) start_pose_at_ = kNever;
}

std::string GlobalLocalizationNode::rejection_reason(const elevation_t& message) const {
  const double age_s = to_seconds(node_.now() - message.header.utime);
  if (age_s < 0.0) return "from the future";
  if (age_s > config_.max_map_age_s * node_.options().cpu_scale) return "stale";
  if (message.header.utime <= last_map_) return "not newer than the last map";
  const std::string fault = fault_of(message);
  if (!fault.empty()) return fault;
  if (std::abs(message.cell_m - config_.local_cell_m) > 1e-6) return "cell size differs from local_cell_m";
  return "";
}

std::optional<Prior> GlobalLocalizationNode::fresh_prior() const {
  const double age_s = to_seconds(node_.now() - pose_.header.utime);
  if (pose_.header.utime == kNever || age_s < 0.0 || age_s > config_.max_pose_age_s) return std::nullopt;
  std::optional<Prior> prior = prior_from(pose_);
  if (prior) prior->since_fix_m = schedule_.since_fix_m(pose_.travelled_m);
  return prior;
}

// A jump of odom invalidates the local map; this happens only after a fault.
void GlobalLocalizationNode::check_for_odometry_jump(const Prior& prior) {
  const double driven_m = pose_.travelled_m - last_travelled_m_;
  const bool started_anew = driven_m < -config_.max_jump_m;  // localization without its checkpoint
  if (last_position_ &&
      (started_anew || (prior.p_odom_body - *last_position_).norm() > std::abs(driven_m) + config_.max_jump_m)) {
    node_.log("WARN", "ODOMETRY_JUMPED local map cleared");
    if (core_) core_->clear_local_map();
    schedule_.restart();
  }
  last_position_ = prior.p_odom_body;
  last_travelled_m_ = pose_.travelled_m;
}

Correction GlobalLocalizationNode::correct(const Prior& prior) {
  Correction none;
  none.reason = "no orbital map";
  if (!core_) return none;
  try {
    return core_->correct(prior);
  } catch (const DtmError& error) {  // the file can be damaged where the rover comes only now
    node_.set_status(heartbeat_t::DEGRADED, error.what());
    none.reason = "orbital map cannot be read";
    return none;
  }
}

Correction GlobalLocalizationNode::attempt_correction(const Prior& prior, Utime utime) {
  const Correction correction = correct(prior);
  schedule_.record_attempt(pose_.travelled_m, correction.accepted);
  correction_t message{};
  correction_to(correction, prior, message);
  node_.publish(channel::kCorrection, message, utime);
  char figures[200];
  std::snprintf(figures, sizeof figures,
                " score=%.3f second=%.3f residual=%.3f second_residual=%.3f expected_sigma_m=%.2f area_m2=%.0f",
                correction.score, correction.second_score, correction.residual, correction.second_residual,
                correction.expected_sigma_m, correction.area_m2);
  node_.log("INFO", (correction.accepted
                         ? std::string("CORRECTION by=") + (correction.layer == Layer::kPicture ? "picture" : "relief")
                         : "NO_CORRECTION reason=" + message.reason) +
                        figures);
  return correction;
}

std::shared_ptr<GlobalLocalizationNode> make_global_localization(Node& node, const std::string& config_dir) {
  return std::make_shared<GlobalLocalizationNode>(node, load_config(config_dir));
}

}  // namespace rover::global
