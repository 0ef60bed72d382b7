// Bus node of the simulator: steps vehicle and cameras, publishes sensor data and ground truth, and is the clock
// master.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <optional>
#include <rover/done_t.hpp>
#include <rover/ptu_command_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <string>
#include <vector>

#include "common/bus/fault_injector.hpp"
#include "common/bus/streams.hpp"
#include "common/core/barrier.hpp"
#include "rover_simulator/command_inbox.hpp"
#include "rover_simulator/fault_script.hpp"
#include "rover_simulator/process_faults.hpp"
#include "rover_simulator/run_end.hpp"
#include "rover_simulator/simulated_rover.hpp"
#include "rover_simulator/world_faults.hpp"

namespace rover {

struct SimulatorOptions {
  std::vector<std::string> participants;  // nodes in the tick barrier
  std::int64_t boot_id = 1;
  bool realtime = false;
  double pace = 1.0;                  // message time over wall time, with realtime
  bool allow_injection = false;       // obey INJECT of other publishers
  std::vector<ScriptedFault> faults;  // applied even without allow_injection
  RunEndConfig end;
};

// Replaces other processes in a run within one process; each may be empty.
struct InProcess {
  std::function<bool()> run_services;  // lets the services work; false if no message waited
  std::function<void(Utime utime, const Eigen::Isometry3d& T_map_left)> loccam;  // exposures, not rendered
  std::function<void(Utime utime, const Eigen::Isometry3d& T_map_left)> navcam;
};

// Summary of a run, for the report.
struct SimulationSummary {
  std::string outcome;  // goal_reached, fault_stop, timeout, stopped or not_started
  bool deterministic = true;
  double simulated_s = 0.0;
  double wall_s = 0.0;
  std::vector<std::string> left;                     // services that left the barrier, with the message time
  std::map<std::string, double> seconds_of_service;  // wall time, in a run within one process
};

class Simulator {
 public:
  // `reports` carries DONE; null: the bus itself.
  Simulator(const SimulatorOptions& options, SimulatedRover& rover, lcm::LCM& lcm, lcm::LCM* reports = nullptr,
            InProcess in_process = {});
  // Returns when the run ends or `running` is false.
  SimulationSummary run(const std::function<bool()>& running);
  // Number of messages that failed to decode, for every subscribed channel.
  const std::map<std::string, std::int64_t>& malformed() const { return malformed_; }

 private:
  struct PendingPair {
    Utime utime;
    Utime release;
    std::future<StereoCameraSim::Pair> pair;
  };
  // A stereo camera on the bus.
  struct Camera {
    const char* left_channel;
    const char* right_channel;
    SensorFaultModel::StereoPair stereo_pair;
    std::optional<PendingPair> exposure;
    std::int64_t frames = 0;
  };
  using Render = std::function<StereoCameraSim::Pair(std::int64_t frame)>;

  bool wait_for_start(const std::function<bool()>& running);
  // Handles reports; false if none came within the timeout.
  bool poll_reports(int timeout_ms);
  void step_world(Utime t);
  void publish_sensors(Utime t);
  void move_pan_tilt(Utime t);
  void publish_pan_tilt(Utime t);
  void start_exposures(Utime t);
  void expose(Camera& camera, Utime t, Render render);
  void publish_due_images(Camera& camera, Utime t);
  void publish_image(const char* channel, const GrayImage& image, double exposure_s, const PendingPair& pending);
  void wait_for_barrier(Utime t, const std::function<bool()>& running);
  void wait_for_listed_messages(const std::function<bool()>& running);
  void handle_missing(const std::vector<std::string>& missing, Utime t, double waited_s);
  bool is_computing(const std::string& name, double waited_s) const;
  void publish_tick(Utime t);
  Utime next_tick(Utime t, const std::function<bool()>& running);
  // simulator_faults.cpp
  void apply_faults(Utime t, const std::function<bool()>& running);
  void begin_scripted(Utime t);
  void begin_requested(Utime t);
  void begin(const injection_t& injection);
  void republish_active_faults(Utime t);
  void send_signal(const ProcessSignal& order, Utime t, const std::function<bool()>& running);
  bool wait_until_idle(const std::string& service, const std::function<bool()>& running);
  void update_driven_distance();
  void on_inject(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void process_states(Utime t, const std::function<bool()>& running);
  void run_full_services(bool run, Utime t, const std::function<bool()>& running);
  std::vector<stream_seq_t> take_released_streams(Utime t);
  WheelCommand command_at(Utime t);
  void on_done(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  template <class Command, CommandInbox<Command> Simulator::*inbox>
  void on_command(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void on_state(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void count_malformed(const std::string& channel);
  template <class Message>
  bool decode(const lcm::ReceiveBuffer* buffer, const std::string& channel, Message& message);
  template <class Message>
  void publish(const char* channel, Message& message, Utime utime, Utime release);

  SimulatorOptions options_;
  SimulatedRover& rover_;
  lcm::LCM& lcm_;
  lcm::LCM& reports_;
  InProcess in_process_;
  StreamCounter streams_;
  Barrier barrier_;
  std::map<std::string, double> cpu_s_;  // CPU time of missing services, one second into the wait
  RunEnd end_;
  ArrivalLedger ledger_;
  std::vector<done_t> pending_done_;           // their streams are not yet listed in a tick
  std::vector<stream_seq_t> awaited_streams_;  // reported messages on subscribed channels that have not arrived
  CommandInbox<wheel_command_t> wheel_commands_;
  CommandInbox<ptu_command_t> ptu_commands_;
  std::deque<supervisor_state_t> states_;
  std::optional<wheel_command_t> command_;
  bool ptu_enabled_ = false;  // switched on by its first command
  bool full_services_run_ = true;
  Camera loccam_;
  Camera navcam_;
  Utime now_ = kNever;
  Utime jumped_ = 0;  // by clock steps, which take no wall time
  std::map<std::string, std::int64_t> malformed_;
  std::vector<std::uint8_t> last_tick_;
  SimulationSummary summary_;

  FaultScript script_;
  ProcessFaults process_faults_;
  WorldFaults world_faults_;
  SensorFaults sensor_faults_;
  SensorFaultModel sensors_;
  std::unique_ptr<FaultInjector> injector_;    // null until the first fault
  std::vector<injection_t> requested_;         // from others, on INJECT
  std::vector<injection_t> announced_;         // own lasting faults, repeated for restarted processes
  std::vector<std::string> members_;           // of the last tick
  std::vector<std::string> informed_members_;  // members that have received the active faults
  std::int64_t injections_ = 0;
  double driven_m_ = 0.0;
  Eigen::Vector2d last_counted_position_ = Eigen::Vector2d::Zero();
};

template <class Message>
bool Simulator::decode(const lcm::ReceiveBuffer* buffer, const std::string& channel, Message& message) {
  if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) return true;
  count_malformed(channel);
  return false;
}

template <class Message>
void Simulator::publish(const char* channel, Message& message, Utime utime, Utime release) {
  message.header = streams_.next(channel, utime, release);
  lcm_.publish(channel, &message);
}

}  // namespace rover
