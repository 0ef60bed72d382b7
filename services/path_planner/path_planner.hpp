// Keeps the rover on the global path and leads it around what the cameras find: hazard memory, block test, local
// repair. Two triggers make a path: a hazard on the active path, and a change of map against odom.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "path_planner/block_finder.hpp"
#include "path_planner/driven_track.hpp"
#include "path_planner/hazard_memory.hpp"
#include "path_planner/local_repair.hpp"
#include "path_planner/plan_job.hpp"
#include "path_planner/pose_history.hpp"
#include "path_planner/repair_agenda.hpp"
#include "path_planner/route.hpp"

namespace rover::planning {

struct PathPlannerConfig {
  Footprint footprint;
  double ground_z_m = 0.0;  // of flat ground in body axes
  double deceleration_mps2 = 0.1;
  HazardMemoryConfig memory;
  LocalRepairConfig repair;  // its footprint is taken from above
  FullPlannerConfig full;
  RoundingConfig rounding;
  double margin_m = 0.12;        // rectangle to the centre of a hazard's cell: 0.05 m of it is the cell
  double tight_margin_m = 0.09;  // where the first finds no way
  double plan_extra_m = 0.05;    // repairs keep that much more, so that a hazard may grow by half a cell
  double sigma_gain = 1.0;       // of the deviation gained since a hazard was seen
  double most_sigma_margin_m = 0.10;
  double pose_max_age_s = 0.5;
  double sure_way_m = 2.5;         // of a repair, over ground that is seen in time
  double least_sure_way_m = 0.6;   // where that leaves no way
  double firm_way_m = 2.0;         // a path whose ground is seen in time for less is replaced where that is possible
  double firm_gain_m = 0.7;        // ... by one that is sure for that much more
  double release_latency_s = 0.1;  // of the path, message time
  double trigger_m = 6.0;          // a block further ahead is left until it comes nearer
  double corridor_half_width_m = 0.75;
  double least_corridor_m = 0.20;
  double goal_tolerance_m = 0.5;             // where the global path names none
  double blocked_goal_reach_m = 1.2;         // a way may end that far from a goal on which hazards lie
  double max_start_offset_m = 0.5;           // from the global path; further away a way to it is planned
  double turn_threshold_rad = to_rad(40.0);  // as trajectory_control: larger heading errors start a point turn
  double turn_stop_rad = to_rad(2.0);        // likewise: it ends here
  double stop_hazard_m = 0.6;                // nearer blocks stand in the way at once: no path if no repair is found
  double stop_unseen_m = 0.35;
  int patience_frames = 4;  // standing before unseen ground, a single hit or a blocked path, until it counts
  double retreat_m = 1.2;   // backwards along the driven track, where no way leads on
  int most_retreats = 5;    // one after the other, without new ground gained
  double retreat_corridor_m = 0.25;
  double correction_m = 0.05;  // movement of map against odom that updates the path
  int frame_work = 800;        // poses expanded for a frame, after which it begins no further search
};

struct GlobalPath {
  std::int64_t id = -1;
  std::vector<RoutePoint> points;  // in map
  double corridor_half_width_m = kNaN;
  double goal_tolerance_m = kNaN;

  // Why it is not a path; empty where it is one.
  std::string fault() const;
};

enum class PlannerState : std::int8_t { kIdle = 0, kFollowing = 1, kRepairing = 2, kNoPath = 3 };
enum class BlockKind : std::int8_t { kNone = 0, kHazard = 1, kUnseen = 2 };
// kRetreat: driven backwards; kContinuous: of the Full level.
enum class PathKind : std::int8_t { kGlobal = 0, kRepair = 1, kRetreat = 2, kContinuous = 3 };

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

struct LocalPath {
  std::int64_t id = -1;
  PathKind kind = PathKind::kGlobal;
  double corridor_half_width_m = 0.0;
  double goal_tolerance_m = 0.0;
  std::vector<RoutePoint> points;  // in odom
};

struct PlannerOutput {
  PlannerStatus status;
  std::optional<LocalPath> path;  // new or changed
};

class PathPlanner {
 public:
  // Path ids count up from first_path_id; a restarted service must not use those of its predecessor.
  PathPlanner(const PathPlannerConfig& config, std::int64_t first_path_id,
              std::shared_ptr<PlanMaker> maker = std::make_shared<PlanAtOnce>());

  // Empty: accepted; otherwise why not, and the old path stays.
  std::string set_global_path(const GlobalPath& path);
  // The operator certifies a circle in map as clear; odom begins anew, so everything remembered in it goes.
  void set_start_area(Point2 center_map, double radius_m, Utime utime);
  void add_pose(const PoseSample& sample);
  // False where the frame cannot be laid: the grid contradicts itself, or no pose of its exposure is known.
  bool add_hazards(const HazardGrid& grid);
  // The level that the supervisor is on.
  void set_level(bool full);
  // False where the map cannot be used: it contradicts itself, or the level is not Full.
  bool add_traversability(const TraversabilityGrid& map);
  // The path is not to be driven on (FDIR): once the rover stands, another one is looked for.
  void request_replan() { replan_wanted_ = true; }
  // As long as it is wanted (FDIR): from where the rover stands only the way back helps, over ground that was driven.
  void want_retreat(bool wanted) { retreat_wanted_ = wanted; }
  PlannerOutput step(Utime now);

  std::vector<std::uint8_t> save() const;
  // False where the bytes are not a state; the planner is then unchanged.
  bool restore(const std::vector<std::uint8_t>& bytes);

  const HazardMemory& memory() const { return memory_; }
  const Route& active_route() const { return active_.route; }
  const RepairResult& last_repair() const { return last_repair_; }

 private:
  static constexpr double kGoalShare = 0.6;  // of the goal's tolerance, for the plan

  struct Active {
    Route route;
    std::int64_t id = -1;
    PathKind kind = PathKind::kGlobal;
    double repair_end_m = 0.0;
    double margin_m = 0.0;
    double corridor_half_width_m = 0.0;
    double progress_m = 0.0;
    double cost = kInfinity;            // of the newest plan, where it was made ...
    double cost_at_m = 0.0;             // ... along the route
    std::optional<Pose2> retreat_from;  // of a way back over the own track
  };
  // What the rover drives of its own accord before a repair bends away.
  struct LeadIn {
    double way_m = 0.0;
    double curvature_per_m = 0.0;
  };
  // A place that the active plan led through and where it was found closed, and what the rest of it would cost.
  struct ClosedGap {
    Point2 p;
    double cost_left = 0.0;
  };
  // A plan that is being made, and what it was made for: anything else since then and it is of no use.
  struct Making {
    std::shared_ptr<const PlanJob> job;
    std::int64_t path_id = -1;
    bool turning = false;
    std::optional<ClosedGap> closed;
    bool pressing = false;
    bool aside = false;  // for a single hit: of use only where the rover drives on past it
    bool again = false;  // something new has come meanwhile
  };
  enum class SearchEnd { kFound, kNone, kGoesOn };
  struct StartArea {
    Point2 center_map;
    double radius_m = 0.0;
    Utime utime = kNever;
  };

  bool ready(Utime now) const;
  Pose2 rover() const { return planar(history_.newest().T_odom_body); }
  void take_start_area();
  void forget_way();
  void lay_global_path();
  void send_again(PlannerOutput& out);
  LocalPath published() const;
  void track_progress();
  void begin(PlannerOutput& out);
  void react(PlannerOutput& out);
  void follow_correction(PlannerOutput& out);
  bool in_the_way() const;
  bool stuck() const;
  bool strayed() const;
  bool retreat(PlannerOutput& out);
  void look_from_retreat(PlannerOutput& out);
  bool retreat_as_wanted(PlannerOutput& out);
  bool at_retreat_end() const;
  void track_driven_way();
  void leave_repair(PlannerOutput& out);
  void judge();
  bool repair(bool because_of_hazard, PlannerOutput& out);
  void take_repair(PlannerOutput& out);
  RepairResult plan_repair(const Terrain& terrain, const LeadIn& lead, double margin_m, const WayDemand& demand) const;
  SearchEnd search(const Terrain& terrain, const std::vector<WayDemand>& demands, RepairAgenda& agenda);
  std::vector<WayDemand> demands() const;
  bool goal_near() const;
  double goal_reach_m() const { return kGoalShare * global_->goal_tolerance_m; }
  std::vector<LeadIn> lead_ins() const;
  double seen_way(const Terrain& terrain, const std::vector<Pose2>& poses) const;
  void track_turn(const Pose2& heading_on);
  bool continuous() const;
  Terrain terrain() const { return {memory_, continuous() ? &ground_ : nullptr, Terrain::Reach::kMemory}; }
  void go_on(PlannerOutput& out);
  double way_left_m() const;
  std::optional<ClosedGap> closed_gap() const;
  void note_closed_gap(const ClosedGap& gap, const FullPlan& plan);
  bool halted_before_block();
  bool at_turn() const;
  std::vector<Point2> way_back(const std::vector<Point2>& track) const;
  std::vector<Point2> straight_back(const Pose2& from, double way_m) const;
  std::vector<Point2> turned_back(double way_m) const;
  std::vector<Point2> clear_part(const std::vector<Point2>& back) const;
  void want_plan(const std::optional<ClosedGap>& closed, PlannerOutput& out, bool aside = false);
  void take_result(bool pressing, PlannerOutput& out);
  bool still_of_use(const Making& making) const;
  bool leads_aside(const FullPlan& plan) const;
  void go_without(const FullPlan& none, PlannerOutput& out);
  void retreat_if_stuck(PlannerOutput& out);
  void fill(FullRequest& request) const;
  LeadIn lead_to_plan() const;
  std::optional<HeldWay> held_way() const;
  double held_end_m() const;
  void take_plan(const FullPlan& plan, const FullRequest& request, PlannerOutput& out);
  void drive_ahead_first(const FullPlan& plan, const FullRequest& request);
  std::vector<RoutePoint> way_to_plan(const FullPlan& plan, const FullRequest& request) const;
  void drive_leg(std::vector<RoutePoint> points, PlannerOutput& out);
  bool on_manoeuvre() const;
  void go_on_manoeuvre(PlannerOutput& out);
  bool legs_blocked() const;
  void give_up_manoeuvre();
  void append_way_back(double station_m, std::vector<RoutePoint>& points) const;
  void append_poses(const std::vector<Pose2>& poses, double end_station_m, std::vector<RoutePoint>& points) const;
  void firm_up(PlannerOutput& out);
  void adopt(Route route, PathKind kind, PlannerOutput& out);
  Route repaired_route(const RepairResult& repair) const;
  double sigma_margin_m() const;
  bool standing() const;
  double hazard_ahead_m() const;
  double unseen_ahead_m() const { return block_.unseen_m - active_.progress_m; }
  PlannerStatus status(Utime now) const;
  void describe_block(PlannerStatus& status) const;
  double short_of_goal_m() const;
  bool leads_to_goal() const;
  double goal_distance_m() const;

  PathPlannerConfig config_;
  LocalRepair local_repair_;
  HazardMemory memory_;
  GroundMap ground_;  // of the Full level
  PoseHistory history_;
  DrivenTrack driven_;
  std::optional<StartArea> start_area_;
  std::optional<GlobalPath> global_;
  Route global_map_;   // rounded, in map
  Route global_odom_;  // the same in odom
  Pose2 T_map_odom_laid_;
  double global_progress_m_ = 0.0;
  Active active_;
  Block block_;
  bool resumed_ = false;     // from a checkpoint: the active path has to be sent again
  bool new_ground_ = false;  // seen or certified since the last judgement
  std::int64_t next_path_id_;
  std::int32_t replans_ = 0;
  bool replan_wanted_ = false;
  bool retreat_wanted_ = false;
  int failures_ = 0;
  std::vector<DeadEnd> dead_ends_;  // where retreats began and gaps were found closed, near the rover
  int retreats_ = 0;                // since the rover last got further along the global path than ever
  int wanted_retreats_ = 0;         // likewise, those of them that FDIR wanted
  double furthest_m_ = 0.0;         // along the global path
  double horizon_from_m_ = 0.0;     // likewise, to the last cm
  bool turning_ = false;            // on the spot, to the active path's heading
  int frames_before_unseen_ = 0;
  int frames_before_possible_ = 0;
  bool full_level_ = false;
  bool new_map_ = false;            // since the last judgement
  bool plan_waits_ = false;         // one is wanted, but another one was being made
  Utime map_utime_ = kNever;        // of the newest map; kNever: none
  double map_travelled_m_ = 0.0;    // by the rover when it came
  std::deque<CurveLeg> legs_;       // of the plan that is being driven, those to come
  double legs_end_m_ = 0.0;         // along the global path: where the last one ends ...
  double legs_goal_reach_m_ = 0.0;  // ... and within this of the goal it is there
  bool no_way_on_ = false;          // from the rover by all that is known: driving on would lead deeper into a dead end
  RepairAgenda agenda_;
  RepairAgenda firm_agenda_;
  std::shared_ptr<PlanMaker> maker_;
  std::optional<Making> making_;
  Utime now_ = kNever;  // of the step
  RepairResult last_repair_;
  LeadIn last_lead_;            // of the last repair
  double last_margin_m_ = 0.0;  // likewise
};

}  // namespace rover::planning
