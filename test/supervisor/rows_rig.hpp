// Test harness: the supervisor node with healthy inputs at their rates, into which tests inject faults.
#pragma once

#include <functional>
#include <map>
#include <rover/command_ack_t.hpp>
#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <set>

#include "supervisor/config.hpp"
#include "supervisor/node.hpp"
#include "test/trajectory_control/bus_world.hpp"

namespace rover::supervisor {

// Disturbance of the messages on the bus.
enum class Bus { kPlain, kDuplicates, kOutOfOrder };

struct ServiceOnBus {
  std::int64_t boot_id = 1;
  std::int8_t status = heartbeat_t::OK;
  std::int64_t received = 0;
  std::int64_t lost = 0;
  bool silent = false;
};

// A row raised or cleared; `tick` counts from the start.
struct RowChange {
  std::string id;
  bool raised;
  std::int64_t tick;
  std::int8_t condition;
  bool first;
};

class RowsRig {
 public:
  explicit RowsRig(Bus bus = Bus::kPlain);

  void tick();
  void run(double seconds);
  // Returns whether it was accepted; false without acknowledgement.
  bool command(std::int8_t kind, const std::string& target = "", std::int8_t level = ground_command_t::AUTO);
  // Starts a drive, at the Full level if requested. Returns whether a permit was granted without any fault.
  bool start_driving(bool full);
  // Returns whether the row becomes active within that time.
  bool raised_within(const std::string& id, double seconds);
  bool cleared_within(const std::string& id, double seconds);
  bool permit_within(double seconds);
  bool is_active(const std::string& id) const;
  bool permitted() const { return !permits_->empty() && permits_->back().granted == 1; }
  const std::vector<RowChange>& changes();

  pose_t pose{};
  planner_status_t planner{};
  path_t path{};
  control_status_t control{};
  hazards_t hazards{};
  slip_t slip{};
  wheel_state_t wheels{};
  imu_t imu{};
  traversability_t terrain{};
  slam_pose_t slam{};
  vo_motion_t visual{};
  bool wheels_follow = true;  // wheels turn if permitted
  bool odometry_alive = true;
  std::set<std::string> silent;  // channels without messages
  std::map<std::string, ServiceOnBus> services;
  std::function<void()> each_tick = [] {};
  test::BusWorld world;

 private:
  template <class Message>
  void send(const std::string& channel, Message message, const std::string& publisher = "world",
            std::int64_t boot_id = 1);
  void send_sensors();
  void send_decisions();
  void send_heartbeats();
  void record_changes();

  Bus bus_;
  SupervisorConfig config_;
  Node node_;
  SupervisorNode service_;
  std::shared_ptr<std::vector<drive_permit_t>> permits_;
  std::shared_ptr<std::vector<command_ack_t>> acks_;
  std::shared_ptr<std::vector<fault_t>> faults_;
  std::map<std::pair<std::string, std::int64_t>, StreamCounter> counters_;
  std::map<std::string, std::function<void()>> delayed_;  // by channel and publisher: sent after the next message
  std::vector<RowChange> changes_;
  std::set<std::string> active_;
  size_t recorded_ = 0;
  std::int64_t ticks_ = 0;
  std::int64_t command_id_ = 0;
};

}  // namespace rover::supervisor
