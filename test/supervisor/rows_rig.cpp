#include "test/supervisor/rows_rig.hpp"

#include "common/bus/convert.hpp"

namespace rover::supervisor {
namespace {

constexpr std::int64_t kDelayEvery = 7;  // one of this many messages of a stream is delayed

}  // namespace

RowsRig::RowsRig(Bus bus)
    : bus_(bus),
      config_(load_config(ROVER_SOURCE_DIR "/config")),
      node_({.name = "supervisor"}, world.bus),
      service_(node_, config_, [](const std::string&, const char*) { return false; }),
      permits_(world.listen<drive_permit_t>(channel::kDrivePermit)),
      acks_(world.listen<command_ack_t>(channel::kCommandAck)),
      faults_(world.listen<fault_t>(channel::kFault)) {
  pose_to(Eigen::Isometry3d::Identity(), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
  pose_to(Eigen::Isometry3d::Identity(), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
  planner.path_id = control.path_id = path.path_id = 3;
  planner.state = planner_status_t::FOLLOWING;
  planner.blocked_in_m = kInfinity;
  planner.goal_distance_m = 100.0;
  control.state = control_status_t::FOLLOWING;
  control.corridor_half_width_m = 0.75;
  hazards.coverage = 0.9f;
  slip.valid = 1;
  terrain.cell_m = 2000.0;
  terrain.origin_x_m = terrain.origin_y_m = -1000.0;
  terrain.cells_x = terrain.cells_y = 1;
  terrain.size = 1;
  terrain.step_percent = {0};
  terrain.height_m = {0.0F};
  terrain.cells = {0};
  terrain.difficulty = 0.8;
  for (const std::string& name : config_.fdir.required_services) services[name] = {};
  for (const std::string& name : config_.fdir.optional_services) services[name] = {};
  for (const std::string& name : config_.fdir.full_services) services[name] = {};
}

template <class Message>
void RowsRig::send(const std::string& channel, Message message, const std::string& publisher, std::int64_t boot_id) {
  if (silent.contains(channel)) return;
  StreamCounter& counter = counters_.try_emplace({publisher, boot_id}, StreamCounter(publisher, boot_id)).first->second;
  message.header = counter.next(channel, world.now, world.now + kTickUs);
  const auto publish = [this, channel, message] { world.bus.publish(channel, &message); };
  std::function<void()>& delayed = delayed_[channel + " " + publisher];
  if (bus_ == Bus::kOutOfOrder && message.header.seq % kDelayEvery == 0) {
    delayed = publish;
    return;
  }
  publish();
  if (bus_ == Bus::kDuplicates) publish();
  if (delayed) delayed();
  delayed = nullptr;
}

void RowsRig::tick() {
  each_tick();
  send_sensors();
  send_decisions();
  if (ticks_ % 10 == 0) send_heartbeats();
  world.tick(node_);
  world.bus.handleTimeout(0);
  ++ticks_;
  record_changes();
}

void RowsRig::send_sensors() {
  if (wheels_follow) std::fill_n(wheels.drive_rate_radps, 6, permitted() ? 1.6 : 0.0);
  if (odometry_alive) pose.last_vo_utime = world.now;
  pose.velocity_body_mps[0] = 0.125 * wheels.drive_rate_radps[0];
  pose.travelled_m += pose.velocity_body_mps[0] * to_seconds(kTickUs);
  send(channel::kPose, pose);
  send(channel::kWheelState, wheels);
  send(channel::kImu, imu);
  if (ticks_ % 5 == 0) send(channel::kSlip, slip);
}

void RowsRig::send_decisions() {
  send(channel::kPlannerStatus, planner);
  if (ticks_ % 50 == 0) send(channel::kPath, path);
  send(channel::kControlStatus, control);
  send(channel::kMotionCommand, motion_command_t{});
  if (ticks_ % 20 == 0) send(channel::kHazards, hazards);
  if (ticks_ % 20 == 0) send(channel::kVo, visual);
  if (ticks_ % 50 == 0) send(channel::kTraversability, terrain);
  if (ticks_ % 50 == 0) send(channel::kSlamPose, slam);
}

void RowsRig::send_heartbeats() {
  for (auto& [name, service] : services) {
    if (service.silent) continue;
    service.received += 100;
    heartbeat_t message{};
    message.service = name;
    message.status = service.status;
    message.input_count = 1;
    message.inputs.resize(1);
    message.inputs[0].received = service.received;
    message.inputs[0].gaps = service.lost;
    send(channel::kHeartbeat, message, name, service.boot_id);
  }
}

// Active faults are republished each second; only changes are recorded.
void RowsRig::record_changes() {
  for (; recorded_ < faults_->size(); ++recorded_) {
    const fault_t& fault = (*faults_)[recorded_];
    const bool raised = fault.active == 1;
    if (raised ? !active_.insert(fault.id).second : active_.erase(fault.id) == 0) continue;
    changes_.push_back({fault.id, raised, ticks_, fault.condition, fault.first == 1});
  }
}

void RowsRig::run(double seconds) {
  for (const Utime end = world.now + to_utime(seconds); world.now < end;) tick();
}

bool RowsRig::command(std::int8_t kind, const std::string& target, std::int8_t level) {
  ground_command_t message{};
  message.kind = kind;
  message.command_id = ++command_id_;
  message.target = target;
  message.level = level;
  message.header = counters_.try_emplace({"ground", 1}, StreamCounter("ground", 1))
                       .first->second.next(channel::kGroundCommand, world.now, world.now + kTickUs);
  world.bus.publish(channel::kGroundCommand, &message);
  tick();
  return !acks_->empty() && acks_->back().command_id == command_id_ && acks_->back().accepted == 1;
}

bool RowsRig::start_driving(bool full) {
  run(2.0);
  if (full && !command(ground_command_t::FORCE_LEVEL, "", ground_command_t::FULL)) return false;
  if (!command(ground_command_t::GO)) return false;
  run(2.0);
  return permitted() && changes_.empty();
}

bool RowsRig::is_active(const std::string& id) const {
  return active_.contains(id);
}

bool RowsRig::raised_within(const std::string& id, double seconds) {
  for (const Utime end = world.now + to_utime(seconds); world.now < end && !is_active(id);) tick();
  return is_active(id);
}

bool RowsRig::cleared_within(const std::string& id, double seconds) {
  for (const Utime end = world.now + to_utime(seconds); world.now < end && is_active(id);) tick();
  return !is_active(id);
}

bool RowsRig::permit_within(double seconds) {
  for (const Utime end = world.now + to_utime(seconds); world.now < end && !permitted();) tick();
  return permitted();
}

const std::vector<RowChange>& RowsRig::changes() {
  return changes_;
}

}  // namespace rover::supervisor
