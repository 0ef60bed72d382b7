// The quantities of the rows, recomputed from the messages. Independent of the supervisor, except for the state that
// arms the rows.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <string>

#include "common/core/frames.hpp"
#include "test/bench_faults/judge/deliveries.hpp"
#include "test/bench_faults/judge/visibility.hpp"

namespace rover::bench_faults {

class Evidence {
 public:
  explicit Evidence(const Settings& settings) : settings_(settings) {}

  void take(const Delivery& delivery);
  // STATE and DRIVE_PERMIT of previous ticks.
  void state(const supervisor_state_t& state);
  void permit(const drive_permit_t& permit) { permitted_ = permit.granted != 0; }
  void kill_ordered(const std::string& service, Utime at) { kills_[service].push_back(at); }
  // Counters of starts, kills and stops are reset by ground command.
  void forget_counts();
  void force_level(std::int8_t level) { forced_level_ = level; }
  // Once each tick, after its messages.
  void tick(Utime now);

  bool armed(const Row& row) const;
  Measurement measure(const Row& row) const;

 private:
  struct Service {
    heartbeat_t beat{};
    bool received = false;
    std::deque<Utime> starts;
  };
  struct Loss {
    Utime utime;
    double received;
    double lost;
  };
  void add_heartbeat(const heartbeat_t& beat);
  void add_wheels(const wheel_state_t& wheels);
  Measurement of(const header_t& header, bool bad) const;
  Measurement age(Utime utime) const;
  Measurement counted(double count, const Row& row) const;
  Measurement measure_pose(const Row& row) const;
  Measurement measure_wheels(const Row& row) const;
  Measurement measure_seen(const Row& row) const;
  Measurement measure_followed(const Row& row) const;
  double keep_out_depth_m() const;
  Measurement measure_full(const Row& row) const;
  Measurement measure_service(const Row& row) const;
  Measurement measure_own(const Row& row) const;
  bool stationary() const;

  Settings settings_;
  Utime now_ = kNever;
  double clock_step_s_ = 0.0;
  supervisor_state_t state_{};
  bool permitted_ = false;
  pose_t pose_{};
  imu_t imu_{};
  wheel_state_t wheels_{};
  hazards_t hazards_{};
  planner_status_t planner_{};
  control_status_t control_{};
  path_t path_{};
  slip_t slip_{};
  slam_pose_t slam_{};
  vo_motion_t visual_{};
  double terrain_at_m_ = kNaN;  // travelled distance at the newest TRAVERSABILITY
  int blind_in_a_row_ = 0;
  Utime seen_utime_ = kNever;                // newest frame of HAZARDS that is not blind
  std::map<std::string, header_t> headers_;  // newest header of each channel
  std::array<double, 6> drive_heat_{};
  std::array<double, 4> steer_heat_{};
  std::map<std::string, Service> services_;
  std::deque<Loss> losses_;
  Utime beat_utime_ = kNever;
  std::map<std::string, std::deque<Utime>> kills_;
  std::deque<double> fault_stops_m_;
  std::int8_t forced_level_ = ground_command_t::AUTO;
  Utime full_waits_since_ = kNever;  // Full is required, and the level not yet raised
  Utime turning_since_ = kNever;     // without a permit
  Utime idle_since_ = kNever;        // with one
};

}  // namespace rover::bench_faults
