// The supervisor's node in a world that is well until a test spoils it: every message it takes, at its rate.
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
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <set>

#include "supervisor/config.hpp"
#include "supervisor/node.hpp"
#include "test/trajectory_control/bus_world.hpp"

namespace rover::supervisor {

// What the bus does to the messages.
enum class Bus { kPlain, kDuplicates, kOutOfOrder };

struct ServiceOnBus {
  std::int64_t boot_id = 1;
  std::int8_t status = heartbeat_t::OK;
  std::int64_t received = 0;
  std::int64_t lost = 0;
  bool silent = false;
};

// A row raised or cleared; `tick` counts from the begin.
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
  // The answer to it; refused where there is none.
  bool command(std::int8_t kind, const std::string& target = "", std::int8_t level = ground_command_t::AUTO);
  // Under way, with a permit; in the Full level where asked for. False where that does not come about.
  bool start_driving(bool full);
  // Whether the row stands within that time.
  bool raised_within(const std::string& id, double seconds);
  bool cleared_within(const std::string& id, double seconds);
  bool permit_within(double seconds);
  bool stands(const std::string& id) const;
  bool permitted() const { return !permits_->empty() && permits_->back().granted == 1; }
  const std::vector<RowChange>& changes();

  pose_t pose{};
  planner_status_t planner{};
  control_status_t control{};
  hazards_t hazards{};
  slip_t slip{};
  wheel_state_t wheels{};
  imu_t imu{};
  traversability_t terrain{};
  slam_pose_t slam{};
  bool wheels_follow = true;  // the permit
  bool odometry_lives = true;
  std::set<std::string> silent;  // channels on which nothing is sent
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
  void note_changes();

  Bus bus_;
  SupervisorConfig config_;
  Node node_;
  SupervisorNode service_;
  std::shared_ptr<std::vector<drive_permit_t>> permits_;
  std::shared_ptr<std::vector<command_ack_t>> acks_;
  std::shared_ptr<std::vector<fault_t>> faults_;
  std::map<std::pair<std::string, std::int64_t>, StreamCounter> counters_;
  std::map<std::string, std::function<void()>> held_;  // by channel and publisher: to be sent after what follows it
  std::vector<RowChange> changes_;
  std::set<std::string> standing_;
  size_t noted_ = 0;
  std::int64_t ticks_ = 0;
  std::int64_t command_id_ = 0;
};

}  // namespace rover::supervisor
