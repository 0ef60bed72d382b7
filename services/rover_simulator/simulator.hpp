// The world on the bus: steps vehicle and cameras, publishes what sensors and judges see, and gives the ticks.
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

#include "common/bus/streams.hpp"
#include "common/bus/tap.hpp"
#include "common/core/barrier.hpp"
#include "rover_simulator/command_inbox.hpp"
#include "rover_simulator/fault_script.hpp"
#include "rover_simulator/process_faults.hpp"
#include "rover_simulator/run_end.hpp"
#include "rover_simulator/simulated_rover.hpp"
#include "rover_simulator/world_faults.hpp"

namespace rover {

struct SimulatorOptions {
  std::vector<std::string> participants;  // nodes that the ticks wait for
  std::int64_t boot_id = 1;
  bool realtime = false;
  double pace = 1.0;                  // of message time against the clock, with realtime
  bool allow_injection = false;       // obeys INJECT
  std::vector<ScriptedFault> faults;  // done whether injection is allowed or not
  RunEndConfig end;
};

// What a run leaves for the report.
struct SimulationSummary {
  std::string outcome;  // goal_reached, fault_stop, timeout, stopped, or what kept the run from starting
  bool deterministic = true;
  double simulated_s = 0.0;
  double wall_s = 0.0;
  std::vector<std::string> left;  // services that left the barrier, with the message time
};

class Simulator {
 public:
  // `reports` brings DONE; null: the bus itself.
  Simulator(const SimulatorOptions& options, SimulatedRover& rover, lcm::LCM& lcm, lcm::LCM* reports = nullptr);
  // Runs until the run is over or `running` is false.
  SimulationSummary run(const std::function<bool()>& running);
  // Messages dropped because they do not decode, by channel; every channel taken is listed.
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
    FaultySensors::Lenses lenses;
    std::optional<PendingPair> exposure;
    std::int64_t frames = 0;
  };
  using Render = std::function<StereoCameraSim::Pair(std::int64_t frame)>;

  bool wait_for_start(const std::function<bool()>& running);
  void step_world(Utime t);
  void publish_sensors(Utime t);
  void move_pan_tilt(Utime t);
  void publish_pan_tilt(Utime t);
  void start_exposures(Utime t);
  void expose(Camera& camera, Utime t, Render render);
  void publish_due_images(Camera& camera, Utime t);
  void publish_image(const char* channel, const GrayImage& image, double exposure_s, const PendingPair& pending);
  void wait_for_barrier(Utime t, const std::function<bool()>& running);
  void wait_for_answers(const std::function<bool()>& running);
  void deal_with_missing(const std::vector<std::string>& missing, Utime t, double waited_s);
  bool computes(const std::string& name, double waited_s) const;
  void give_tick(Utime t);
  Utime next_tick(Utime t, const std::function<bool()>& running);
  // simulator_faults.cpp
  void do_faults(Utime t, const std::function<bool()>& running);
  void begin_scripted(Utime t);
  void begin_asked_for(Utime t);
  void begin(const injection_t& injection);
  void announce_again(Utime t);
  void deal(const ProcessBlow& blow, Utime t, const std::function<bool()>& running);
  bool wait_until_idle(const std::string& service, const std::function<bool()>& running);
  void measure_way();
  void on_inject(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void take_states(Utime t);
  std::vector<stream_seq_t> take_grown(Utime t);
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
  StreamCounter streams_;
  Barrier barrier_;
  std::map<std::string, double> cpu_s_;  // of those that are waited for, a second into the wait
  RunEnd end_;
  ArrivalLedger ledger_;
  std::vector<done_t> dones_;          // whose streams no tick has listed yet
  std::vector<stream_seq_t> awaited_;  // reported, on channels taken here
  CommandInbox<wheel_command_t> wheel_commands_;
  CommandInbox<ptu_command_t> ptu_commands_;
  std::deque<supervisor_state_t> states_;
  std::optional<wheel_command_t> command_;
  bool ptu_on_ = false;  // somebody has commanded the pan-tilt unit
  Camera loccam_;
  Camera navcam_;
  Utime now_ = kNever;
  std::map<std::string, std::int64_t> malformed_;
  std::vector<std::uint8_t> last_tick_;
  SimulationSummary summary_;

  FaultScript script_;
  ProcessFaults process_faults_;
  WorldFaults world_faults_;
  SensorFaults broken_;
  FaultySensors sensors_;
  std::unique_ptr<Tap> tap_;            // empty while no fault has been done
  std::vector<injection_t> asked_for_;  // by others, on INJECT
  std::vector<injection_t> announced_;  // by us: a process that starts must hear of those that last
  std::vector<std::string> members_;    // of the last tick
  std::vector<std::string> told_;       // of the faults that stand
  std::int64_t injections_ = 0;
  double driven_m_ = 0.0;
  Eigen::Vector2d way_mark_ = Eigen::Vector2d::Zero();
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
