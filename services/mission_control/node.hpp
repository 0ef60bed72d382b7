// Bus node of the ground station: sends the mission plan and the operator's commands, and keeps the logbook. It never
// subscribes to TRUTH.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <rover/command_ack_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/node.hpp"
#include "mission_control/config.hpp"
#include "mission_control/shared_state.hpp"

namespace rover {

class MissionControlNode {
 public:
  // `each_tick` is called once per tick in the node's thread.
  MissionControlNode(Node& node, MissionPlan plan,
                     std::shared_ptr<mission::SharedState> shared = std::make_shared<mission::SharedState>(),
                     mission::OperatorPathConfig path_config = {}, std::function<void()> each_tick = {});

 private:
  struct ServiceLiveness {
    std::int64_t boot_id = 0;
    Utime last_heartbeat = kNever;
    bool timed_out = false;
  };
  struct UnansweredStop {
    ground_command_t message{};
    Utime repeat_at = kNever;
    Utime give_up_at = kNever;
  };

  void subscribe();
  void on_ack(const command_ack_t& ack);
  void on_state(const supervisor_state_t& state);
  void end_plan(const supervisor_state_t& state);
  void on_fault(const fault_t& fault);
  void on_heartbeat(const heartbeat_t& heartbeat);
  void on_path(const path_t& path);
  void on_pose(const pose_t& pose);
  void sample(Utime now);
  void step(Utime now);
  void check_heartbeats(Utime now);
  void report_status();
  void send(const MissionSequence::Issued& issued);
  void send(const mission::CommandQueue::Pending& waiting);
  void publish_start_pose(std::int64_t command_id);
  void locate(std::int64_t command_id, double within_m);
  GlobalPath current_path() const;
  void send_zones(std::int64_t command_id, const std::vector<Zone>& zones);
  void publish_path(std::int64_t command_id, const GlobalPath& path);
  void publish(ground_command_t message);
  void repeat_stops(Utime now);
  void add_event(mission::Tone tone, const std::string& kind, const std::string& text);
  void accepted_by_operator(const mission::Command& command, std::int64_t command_id);
  void restore();
  void save(Utime now);

  Node& node_;
  CheckpointStore checkpoint_;
  MissionPlan plan_;
  std::shared_ptr<mission::SharedState> shared_;
  mission::OperatorPathConfig path_config_;
  std::function<void()> each_tick_;
  MissionSequence sequence_;
  std::int64_t next_command_id_ = 1;
  bool standby_ = false;
  std::optional<supervisor_state_t> state_;
  pose_t pose_{};
  std::optional<Eigen::Vector2d> p_map_body_;  // the last known
  double slip_ratio_ = kNaN;
  std::map<std::string, ServiceLiveness> liveness_;
  std::map<std::string, bool> faults_;
  std::int64_t path_id_ = -1;
  std::map<std::int64_t, GlobalPath> unacknowledged_paths_;  // by command id
  std::map<std::int64_t, UnansweredStop> unanswered_stops_;  // by command id
  int saved_progress_ = 0;
  bool changed_ = false;  // since the newest checkpoint; the track is saved every 5 s
  Utime track_saved_ = 0;
};

}  // namespace rover
