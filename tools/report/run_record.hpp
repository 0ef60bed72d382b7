// Data of a run from its log and folder, as time series. Times are message time.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/zones.hpp"
#include "tools/report/elevation_mosaic.hpp"

namespace rover::report {

struct TruthSample {
  double t_s = 0.0;
  Eigen::Isometry3d T_map_body = Eigen::Isometry3d::Identity();
  double speed_mps = 0.0;
  double wheel_slip = 0.0;  // mean of the six
  double clearance_m = kInfinity;
  bool collision = false;
};

struct PoseSample {
  double t_s = 0.0;
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d cov_xyyaw = Eigen::Matrix3d::Constant(kNaN);  // of T_map_body, in map axes
};

// Each VO message.
struct VisualSample {
  double from_s = 0.0;
  double to_s = 0.0;
  bool lost = false;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  double keyframe_s = kNaN;
  Matrix6d cov = nan_cov();  // of the alignment with the keyframe, in the axes of the earlier body
};

enum class Following { kIdle, kFollowing, kPointTurn, kPathEnd, kOther };

struct ControlSample {
  double t_s = 0.0;
  Following following = Following::kIdle;
  std::int64_t path_id = -1;
  double cross_track_m = 0.0;
};

struct WheelSample {
  double t_s = 0.0;
  std::array<double, 6> current_a{};
  std::array<double, 6> rate_radps{};  // positive forward; FL FR ML MR RL RR
  std::array<double, 4> steer_rad{};   // positive to the left; FL FR RL RR
};

struct SlipSample {
  double t_s = 0.0;
  double slip_ratio = kNaN;
};

// As supervisor_state_t.
enum class State {
  kBoot,
  kStandby,
  kDriving,
  kHazardStop,
  kRepairing,
  kSweeping,
  kPaused = 7,
  kGoalReached,
  kFaultStop,
  kSafe,
  kTeleop
};
std::string state_name(State state);

// Each change of STATE.
struct StateChange {
  double t_s = 0.0;
  State state = State::kBoot;
  bool full = false;
  std::string cause;
  std::string quantity;  // quantity of the cause; empty: none
  double value = kNaN;
  double threshold = kNaN;
};

struct PathRecord {
  double t_s = 0.0;
  std::int64_t id = -1;
  bool in_odom = false;
  bool is_repair = false;
  std::vector<Eigen::Vector2d> points;
  std::vector<Zone> zones;
};

struct HazardCell {
  Eigen::Vector2d p_body;  // cell centre, at the exposure
  bool hole = false;
};

// One HAZARDS map: cells detected as obstacle or hole, without margins.
struct HazardMap {
  double t_s = 0.0;  // exposure
  double released_s = 0.0;
  bool blind = false;
  double coverage = 0.0;
  double cell_m = 0.1;
  std::vector<HazardCell> cells;
};

// Which ground a HAZARDS map (in body) or a TRAVERSABILITY map (in odom) calls passable.
struct PassabilityMap {
  enum Cell : std::uint8_t { kUnseen, kPassable, kImpassable };
  double t_s = 0.0;
  double cell_m = 0.1;
  double origin_x_m = 0.0;  // corner with the smallest x and y
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  std::vector<Cell> cells;  // index iy * cells_x + ix
  // kUnseen outside.
  Cell at(double x_m, double y_m) const {
    const double ix = std::floor((x_m - origin_x_m) / cell_m);
    const double iy = std::floor((y_m - origin_y_m) / cell_m);
    if (!(ix >= 0.0 && iy >= 0.0 && ix < cells_x && iy < cells_y)) return kUnseen;
    return cells[static_cast<size_t>(iy) * static_cast<size_t>(cells_x) + static_cast<size_t>(ix)];
  }
};

struct PlannerSample {
  double t_s = 0.0;
  bool no_path = false;
  bool blocked_by_unseen = false;
  int replans = 0;
};

// A granted DRIVE_PERMIT.
struct PermitSample {
  double released_s = 0.0;
  double until_s = 0.0;
};

struct FaultRecord {
  double t_s = 0.0;
  std::string id;
  double value = kNaN;
  double limit = kNaN;
  std::string response;
  bool active = false;
};

struct CorrectionRecord {
  double t_s = 0.0;  // of the local map
  bool accepted = false;
  Pose2 T_map_odom;
  double released_s = kNaN;
  std::string reason;  // of a rejection; of a fix: what was matched
};

// Each SLAM_POSE.
struct SlamSample {
  double t_s = 0.0;  // of its cloud
  Pose2 T_slam_odom;
};

// Accumulated CPU time and memory of a process.
struct HeartbeatSample {
  double t_s = 0.0;
  std::int64_t boot_id = 0;
  double cpu_s = 0.0;
  double rss_mb = 0.0;
};

struct ServiceRecord {
  std::map<std::int64_t, double> cpu_s_of_boot;
  int starts_on_demand = 0;  // after having been stopped, because the level needs it
  std::vector<HeartbeatSample> heartbeats;
  double p50_ms = 0.0;
  double p99_ms = 0.0;
  std::map<std::pair<std::int64_t, std::string>, std::int64_t> gaps;  // of each boot and input
};

struct BusRecord {
  std::int64_t messages = 0;  // published messages, by sequence numbers
  std::int64_t bytes = 0;
  int damaged_events = 0;  // undecodable records of the log
  double missing_s = 0.0;  // parts of the log without a TICK for over a second: the disk was full, or the clock jumped
  double missing_end_s = 0.0;  // of these: the time from the last TICK to the end of the run
};

struct RunRecord {
  std::vector<TruthSample> truth;
  std::vector<PoseSample> poses;
  std::vector<ControlSample> control;
  std::vector<WheelSample> wheels;
  std::vector<SlipSample> slip;
  std::vector<StateChange> states;
  std::vector<PathRecord> global_paths;  // those that path_planner accepted
  std::vector<PathRecord> local_paths;
  std::vector<HazardMap> hazards;
  std::vector<PassabilityMap> hazard_maps;  // of the same messages
  std::vector<PassabilityMap> traversability_maps;
  std::vector<PlannerSample> planner;
  std::vector<PermitSample> permits;
  std::vector<FaultRecord> faults;
  std::vector<CorrectionRecord> corrections;
  std::map<std::string, ServiceRecord> services;
  std::vector<SlamSample> slam;
  ElevationMosaic elevation;  // of the Full level
  std::vector<VisualSample> visual;
  BusRecord bus;
};

// run.json, simulation.json and the configuration in the run's folder.
struct RunInfo {
  std::string scenario;
  std::optional<std::int64_t> seed;
  std::string commit;
  std::string level;
  std::string perception;  // rendered, geometric or truth; empty: no simulation, or an older run
  std::optional<bool> deterministic;
  std::optional<bool> realtime;
  std::optional<double> wall_s;
  std::optional<double> sim_s;
  std::string outcome_hint;
  std::map<std::string, int> restarts;
  std::optional<int> data_set_pairs;  // number of stereo pairs; empty: not an imported data set
};

struct VehicleWheels {
  double radius_m = 0.125;
  double width_m = 0.12;
  std::array<Eigen::Vector2d, 6> p_body = {Eigen::Vector2d(0.75, 0.41),  Eigen::Vector2d(0.75, -0.41),
                                           Eigen::Vector2d(0.0, 0.41),   Eigen::Vector2d(0.0, -0.41),
                                           Eigen::Vector2d(-0.75, 0.41), Eigen::Vector2d(-0.75, -0.41)};
};

// Footprint about the body origin, and the origin's height above flat ground.
struct Footprint {
  double half_length_m = 0.875;
  double half_width_m = 0.47;
  double origin_height_m = 0.62;
  double top_speed_mps = 0.2;
  VehicleWheels wheels;
  double loccam_x_m = 0.527;  // in body
  double navcam_x_m = 0.45;
};

struct Rock {
  double x_m = 0.0;
  double y_m = 0.0;
  double radius_m = 0.0;
  double height_m = 0.0;
};

// The true world around the run, only for the evaluation.
struct TrueWorld {
  std::vector<Rock> rocks;
  std::function<double(double x_m, double y_m)> height_m;  // of the surface; empty: unknown
  std::function<double(double x_m, double y_m)> ground_m;  // without rocks
  double width_m = kInfinity;                              // of the map, whose corner is the map frame's origin
  double length_m = kInfinity;
  double goal_tolerance_m = 0.5;  // of the scenario's path
  double corridor_half_width_m = 1.5;
};

}  // namespace rover::report
