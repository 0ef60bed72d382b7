// Publishes a CORRECTION for each attempt, accepted or not, while the level is FULL.
#pragma once

#include <memory>
#include <optional>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <string>

#include "common/bus/node.hpp"
#include "global_localization/attempt_schedule.hpp"
#include "global_localization/config.hpp"
#include "global_localization/global_localization.hpp"

namespace rover::global {

class GlobalLocalizationNode {
 public:
  GlobalLocalizationNode(Node& node, const NodeConfig& config);
  GlobalLocalizationNode(const GlobalLocalizationNode&) = delete;
  GlobalLocalizationNode& operator=(const GlobalLocalizationNode&) = delete;

 private:
  void load_map();
  std::optional<OrbitalMap> load_picture(const std::string& run_dir);
  void on_elevation(const elevation_t& message);
  void search_at_start_pose();
  std::string rejection_reason(const elevation_t& message) const;
  std::optional<Prior> fresh_prior() const;
  void check_for_odometry_jump(const Prior& prior);
  Correction correct(const Prior& prior);
  Correction attempt_correction(const Prior& prior, Utime utime);

  Node& node_;
  NodeConfig config_;
  std::optional<GlobalLocalization> core_;  // empty without an orbital map
  AttemptSchedule schedule_;
  pose_t pose_{};
  bool full_ = false;
  Utime start_pose_at_ = kNever;  // of a start pose that POSE does not contain yet
  Utime last_map_ = kNever;
  std::optional<Utime> searched_map_;             // the newest map in the last search since the start pose
  std::optional<Eigen::Vector2d> last_position_;  // in odom
  double last_travelled_m_ = 0.0;
};

std::shared_ptr<GlobalLocalizationNode> make_global_localization(Node& node, const std::string& config_dir);

}  // namespace rover::global
