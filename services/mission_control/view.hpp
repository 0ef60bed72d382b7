// Snapshot of everything the page shows. Unknown values are NaN or empty.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "mission_control/logbook.hpp"

namespace rover::mission {

struct StateView {
  Utime utime = kNever;
  std::string state;
  std::string level;
  Utime since = kNever;
  std::string cause;     // the event that led here
  std::string quantity;  // measured quantity behind it, else empty
  double value = kNaN;
  double threshold = kNaN;
  int hazard_stops = 0;
  std::vector<std::string> faults;  // ids of active faults, oldest first
};

struct FaultView {
  double value = kNaN;
  double limit = kNaN;
  std::string response;
};

struct PermitView {
  bool granted = false;
  Utime valid_until = kNever;
  double max_speed_mps = kNaN;
  std::string reason;
};

struct PoseView {
  Utime utime = kNever;
  int status = 3;  // pose_t constant
  Eigen::Vector3d position_map_m = Eigen::Vector3d::Constant(kNaN);
  double roll_rad = kNaN;  // against gravity; pitch positive nose down
  double pitch_rad = kNaN;
  double yaw_rad = kNaN;  // in map
  double speed_mps = kNaN;
  double sigma_m = kNaN;
  double travelled_m = kNaN;
  Pose2 map_odom{kNaN, kNaN, kNaN};
};

struct PlannerView {
  int state = 0;  // planner_status_t constant
  double blocked_in_m = kNaN;
  double goal_distance_m = kNaN;
  double corridor_offset_m = kNaN;
  int replans = 0;
  std::string text;
};

struct MotionView {
  double slip_ratio = kNaN;
  double cross_track_m = kNaN;
  double corridor_half_width_m = kNaN;
  std::array<double, 6> drive_current_a = {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};  // the largest since the last view
  std::array<double, 4> steer_rad = {0, 0, 0, 0};
};

// Heartbeats come five times a second; a service without one for this long counts as lost.
constexpr Utime kHeartbeatTimeoutUs = 1'000'000;

// kWaiting: just subscribed. kLost: no process, or heartbeat timeout.
enum class Health { kOk, kDegraded, kFault, kLost, kWaiting, kStopped };

struct ServiceView {
  Health health = Health::kWaiting;
  double age_s = kNaN;  // message time since its last heartbeat
  double cpu_percent = kNaN;
  double rss_mb = kNaN;
  int restarts = -1;  // -1: unknown
  std::string text;
};

struct LocalPathView {
  std::int64_t id = -1;
  int kind = 0;                  // path_t constant
  std::vector<double> x_m, y_m;  // odom
};

// A grid around the rover. `seq` changes with the content.
struct GridView {
  std::int64_t seq = 0;
  Utime utime = kNever;
  Pose2 odom;  // of the grid's axes
  double cell_m = 0.0;
  double origin_x_m = 0.0;  // of the corner with the smallest x and y, in the grid's axes
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  double plane_pitch_rad = 0.0;  // hazards: ground plane ahead
  double plane_roll_rad = 0.0;
  std::string note;  // for the legend
};

struct ImageView {
  std::int64_t seq = 0;
  Utime utime = kNever;
  int width = 0;
  int height = 0;
};

// Services of the Full level. `utime` kNever: nothing received.
struct PanTiltView {
  Utime utime = kNever;
  double pan_rad = kNaN;   // positive to the left
  double tilt_rad = kNaN;  // positive down
  bool moving = false;
};

struct TerrainView {
  Utime utime = kNever;
  double difficulty = kNaN;      // of the ground ahead
  double known_fraction = kNaN;  // of the map's cells
};

struct SlamView {
  Utime utime = kNever;
  int status = 0;  // slam_pose_t constant
  double information = kNaN;
  int particles = 0;
};

struct CorrectionView {
  Utime utime = kNever;
  bool accepted = false;
  double moved_m = kNaN;  // shift of the rover in map if accepted
  double score = kNaN;
  std::string reason;  // if not accepted
};

struct TruthView {
  Utime utime = kNever;
  Eigen::Vector3d position_map_m = Eigen::Vector3d::Constant(kNaN);
  double yaw_rad = kNaN;
};

struct View {
  Utime now = kNever;  // newest TICK
  double realtime_factor = kNaN;
  double tick_age_s = kNaN;  // wall time since that TICK
  StateView state;
  std::map<std::string, FaultView> faults;
  PermitView permit;
  PoseView pose;
  PlannerView planner;
  MotionView motion;
  PanTiltView pan_tilt;
  TerrainView terrain;
  SlamView slam;
  CorrectionView correction;
  std::map<std::string, ServiceView> services;
  LocalPathView path;
  std::map<std::string, GridView> grids;    // hazards, traversability, elevation
  std::map<std::string, ImageView> images;  // loccam, navcam
};

// Logbook fields included in each view.
struct BookView {
  std::int64_t newest_event = 0;
  std::int64_t path_id = -1;
  double path_length_m = kNaN;
  std::string forced_level;  // empty: chosen on board
  int pages = 0;
};

// Compact JSON on one line.
std::string to_json(const View& view, const BookView& book);
std::string to_json(const TruthView& truth);

}  // namespace rover::mission
