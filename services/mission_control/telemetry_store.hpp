// Stores the newest message of each type in the form the page shows. Wall time is in seconds of a steady clock.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <rover/control_status_t.hpp>
#include <rover/correction_t.hpp>
#include <rover/disparity_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/image_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/core/image.hpp"
#include "mission_control/view.hpp"

namespace rover::mission {

struct GridContent {
  std::int64_t seq = 0;
  int cells_x = 0;
  int cells_y = 0;
  double cell_m = 0.0;
  std::vector<std::uint8_t> cells;  // hazards, traversability
  std::vector<float> heights_m;     // elevation
};

class TelemetryStore {
 public:
  // `services`: names of the services expected to send heartbeats.
  explicit TelemetryStore(const std::vector<std::string>& services);

  // Clears everything except the camera parameters, so that stale data is never shown.
  void reset();
  void add(const tick_t& message, double wall_s);
  void add(const heartbeat_t& message, double wall_s);
  void add(const supervisor_state_t& message);
  void add(const fault_t& message);
  void add(const drive_permit_t& message);
  void add(const pose_t& message);
  void add(const planner_status_t& message);
  void add(const control_status_t& message);
  void add(const slip_t& message);
  void add(const wheel_state_t& message);
  void add(const path_t& message);
  void add(const hazards_t& message);
  void add(const traversability_t& message);
  void add(const elevation_t& message);
  void add(const ptu_state_t& message);
  void add(const slam_pose_t& message);
  void add(const correction_t& message);
  void add_loccam(const image_t& message);
  void add_navcam(const image_t& message);
  void add(const disparity_t& message);
  void add(const truth_t& message);

  // Resets the peak drive currents.
  View view(double wall_s);
  const TruthView& truth() const { return truth_; }
  const LocalPathView& path() const { return view_.path; }
  // Rectified LocCam; empty until received.
  const std::optional<StereoCamera>& camera() const { return camera_; }

  // Content of a grid or image; empty until received.
  std::optional<GridContent> grid(const std::string& name) const;
  std::shared_ptr<const image_t> image(const std::string& name) const;

 private:
  struct ServiceRecord {
    Utime last_heartbeat = kNever;
    std::int64_t boot_id = 0;
    int pid = 0;
    int status = heartbeat_t::OK;
    double rss_mb = kNaN;
    std::string text;
    std::deque<std::pair<double, double>> cpu;  // wall time, processor time
  };
  ServiceView view_of(const std::string& name, const ServiceRecord& record) const;
  Pose2 odom_at(Utime utime) const;
  void select_loccam_image();
  void show(const std::string& name, const std::shared_ptr<const image_t>& image);
  GridContent& set_grid(const std::string& name, const header_t& header, const Pose2& odom, double cell_m, double x_m,
                        double y_m, int nx, int ny);

  std::vector<std::string> expected_;
  Utime first_tick_ = kNever;
  View view_;
  TruthView truth_;
  std::optional<StereoCamera> camera_;
  std::map<std::string, ServiceRecord> services_;
  bool full_services_run_ = true;
  int starts_on_demand_ = 0;                           // of the services of the Full level
  std::deque<std::pair<Utime, double>> ticks_;         // with wall time
  std::deque<std::pair<Utime, Pose2>> poses_;          // odom
  std::deque<std::shared_ptr<const image_t>> loccam_;  // waiting for their hazard grids
  std::map<std::string, GridContent> grids_;
  std::map<std::string, std::shared_ptr<const image_t>> images_;
};

}  // namespace rover::mission
