// Keeps the rover on the global path and leads it around what the cameras find: belief map, path check, one search for
// both levels, and a table of states for when no path is found.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/zones.hpp"
#include "path_planner/active_path.hpp"
#include "path_planner/background.hpp"
#include "path_planner/breadcrumbs.hpp"
#include "path_planner/map/belief_map.hpp"
#include "path_planner/path_monitor.hpp"
#include "path_planner/planner_state.hpp"
#include "path_planner/pose_history.hpp"
#include "path_planner/search/planners.hpp"

namespace rover::planning {

struct PathPlannerConfig {
  Footprint footprint;
  double origin_height_m = 0.0;  // of the body origin above the ground
  double deceleration_mps2 = 0.1;
  BeliefConfig belief;
  CostmapConfig costmap;
  std::string planner_name = "hybrid_a_star";
  HybridPlannerConfig planner;  // footprint and view are taken from here
  RoundingConfig rounding;
  double pose_max_age_s = 0.5;
  double release_latency_s = 0.1;                  // of a path, message time
  double planning_latency_s = 0.1;                 // of a plan, message time
  double corridor_half_width_m = 1.5;              // if the global path has none
  double min_corridor_m = 0.25;                    // of a path between hazards, or over the driven track
  double goal_tolerance_m = 0.5;                   // if the global path has none
  static constexpr double kMaxStartOffsetM = 0.5;  // farther from the global path, a path to it is planned
  double turn_threshold_rad = to_rad(40.0);        // as trajectory_control: larger heading errors start a point turn
  double turn_stop_rad = to_rad(2.0);              // and it ends here
  double stop_hazard_m = 0.6;                      // a hazard nearer along the path stops the rover
  double stop_unknown_m = 0.35;                    // and unknown ground
  int patience = 4;                                // plans not found before the rover backs up
  double back_up_m = 1.2;                          // the first time; twice that the second time
  int max_back_ups = 5;                            // without progress along the global path
  static constexpr double kCorrectionM = 0.05;     // movement of map against odom that updates the path
};

struct GlobalPath {
  std::int64_t id = -1;
  std::vector<RoutePoint> points;  // in map
  double corridor_half_width_m = kNaN;
  double goal_tolerance_m = kNaN;
  std::vector<Zone> zones;

  // Why it is not a path; empty if it is.
  std::string fault() const;
};

enum class PlannerState : std::int8_t { kIdle = 0, kFollowing = 1, kRepairing = 2, kNoPath = 3 };
enum class BlockKind : std::int8_t { kNone = 0, kHazard = 1, kUnseen = 2 };

struct PlannerStatus {
  PlannerState state = PlannerState::kIdle;
  std::int64_t path_id = -1;
  std::int64_t global_path_id = -1;
  double blocked_in_m = 0.0;
  BlockKind block_kind = BlockKind::kUnseen;
  std::int32_t replans = 0;
  double goal_distance_m = kNaN;
  double corridor_offset_m = kNaN;
  std::string text;
};

struct PlannerOutput {
  PlannerStatus status;
  std::optional<LocalPath> path;  // new or changed
};

class PathPlanner {
 public:
  // Path ids count up from first_path_id; a restarted service must not use those of its predecessor.
  PathPlanner(const PathPlannerConfig& config, std::int64_t first_path_id,
              std::shared_ptr<Background> background = std::make_shared<AtOnce>());

  // Empty: accepted; otherwise why not, and the old path stays.
  std::string set_global_path(const GlobalPath& path);
  // The operator certifies a circle in map as clear.
  void set_start_area(Point2 center_map, double radius_m, Utime utime);
  void add_pose(const PoseSample& sample);
  // False if the frame cannot be inserted: it contradicts itself, or no pose of its exposure is known.
  bool add_hazards(const HazardGrid& grid);
  void set_level(bool full);
  // False if the map cannot be used: it contradicts itself, or the level is not Full.
  bool add_traversability(const TraversabilityGrid& map);
  // FDIR: the path is not to be driven on.
  void request_replan() { replan_wanted_ = true; }
  // FDIR: as long as it is wanted, only driven ground helps.
  void request_back_up(bool wanted) {
    if (wanted != back_up_wanted_) back_up_plan_.reset();  // it may leave driven ground
    back_up_wanted_ = wanted;
  }
  PlannerOutput step(Utime now);

  std::vector<std::uint8_t> save() const;
  // False if the bytes are not a state; the planner is then unchanged.
  bool restore(const std::vector<std::uint8_t>& bytes);

  const BeliefMap& belief() const { return belief_; }
  const ActivePath& active_path() const { return active_; }
  Mode mode() const { return mode_; }

 private:
  struct StartArea {
    Point2 center_map;
    double radius_m = 0.0;
    Utime utime = kNever;
  };
  // A plan that is being made, and what for.
  struct Job {
    std::int64_t path_id = -1;
    ActivePath::Start start;
    bool because_of_hazard = false;
    bool back_up = false;
  };

  bool ready(Utime now) const;
  Pose2 rover() const { return planar(history_.newest().T_odom_ground); }
  bool stationary() const;
  void apply_start_area();
  void forget_path();
  void set_global_in_odom(const Pose2& T_map_odom);
  double place_on_global_path() const;

  void follow();
  void follow_global_path();
  void follow_correction();
  void track_progress();
  bool turns_to(double yaw_rad) const;
  void track_turn();
  Costmap monitor_costmap(CostmapUse use) const;
  void check_path();
  std::uint16_t facts(Utime now);
  bool clear() const;
  bool strayed() const;

  void request(Utime now);
  bool wants_plan() const;
  PlanRequest request_from(const ActivePath::Start& start) const;
  void request_plan();
  ExpectedMotion expected_motion() const;
  ActivePath::Start plan_start() const;
  void take_plan(Utime now);
  void adopt(const Plan& plan, const Job& job);
  std::vector<RoutePoint> tail(const Pose2& from, const Pose2& start) const;

  bool failed() const { return failures_ >= config_.patience && (mapped_ || !full_level_); }
  bool may_back_up() const;
  bool wants_back_up() const;
  void request_back_up_plan();
  void back_up();

  double hazard_ahead_m() const { return blockage_.hazard_m - active_.progress_m(); }
  double unseen_ahead_m() const { return blockage_.unseen_m - active_.progress_m(); }
  double unknown_ahead_m() const { return blockage_.unknown_m - active_.progress_m(); }
  double stopping_distance_m() const;
  double margin_m() const;
  PlannerStatus status(Utime now) const;
  bool leads_to_goal() const;
  double short_of_goal_m() const;
  double goal_distance_m() const;
  LocalPath published() const;

  PathPlannerConfig config_;
  std::shared_ptr<const Planner> planner_;
  std::shared_ptr<Background> background_;
  BeliefMap belief_;
  PoseHistory history_;
  bool odom_ended_ = false;  // localization begins anew
  Breadcrumbs breadcrumbs_;
  std::optional<StartArea> start_area_;
  std::optional<GlobalPath> global_;
  Route global_map_;                          // rounded, in map
  std::shared_ptr<const Route> global_odom_;  // the same in odom
  std::vector<Zone> zones_odom_;              // of the global path
  Pose2 T_map_odom_;                          // with which it was transformed
  double global_progress_m_ = 0.0;
  double furthest_m_ = 0.0;  // along the global path
  ActivePath active_;
  Blockage blockage_;
  bool turning_ = false;  // on the spot, to the heading of the active path
  SideSlip side_slip_;
  Mode mode_ = Mode::kIdle;
  std::optional<Job> job_;
  int failures_ = 0;                  // plans not found, in a row
  bool needs_unseen_ground_ = false;  // the last of them
  bool closed_in_ = false;            // the same
  std::optional<Plan> back_up_plan_;  // from where the rover is stationary; none: not asked for yet
  int back_ups_ = 0;                  // since the rover last made progress
  int wanted_back_ups_ = 0;           // of them, those that FDIR wanted
  bool full_level_ = false;
  bool new_ground_ = false;       // since the last step
  bool new_level_ = false;        // since the last step
  double dead_reckoned_m_ = 0.0;  // total at the newest map of the NavCam
  bool mapped_ = false;           // by the NavCam, since the Full level began
  bool new_map_ = false;          // of the NavCam, since the last plan
  bool replan_wanted_ = false;
  bool back_up_wanted_ = false;
  std::int64_t next_path_id_;
  std::int64_t sent_path_id_ = -1;
  std::int32_t replans_ = 0;
};

}  // namespace rover::planning
