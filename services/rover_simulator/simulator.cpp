#include "rover_simulator/simulator.hpp"

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <rover/tick_t.hpp>
#include <thread>

#include "common/bus/channels.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/streams.hpp"
#include "rover_simulator/convert.hpp"
#include "rover_simulator/exposure_times.hpp"

namespace rover {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Utime kRejoinDelay = 1'000'000;  // the barrier waits again for a service this long after it left
constexpr double kStartTimeout_s = 60.0;
constexpr double kResendPeriod_s = 1.0;
constexpr double kSilenceTimeout_s = 10.0;
constexpr double kBusyTimeout_s = 120.0;  // timeout of a process that uses at least kMinBusyCpuShare of CPU time
constexpr double kMinBusyCpuShare = 0.05;
constexpr double kLostMessageTimeout_s = 2.0;

bool all_finite(const wheel_command_t& command) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::all_of(std::begin(command.drive_rate_radps), std::end(command.drive_rate_radps), finite) &&
         std::all_of(std::begin(command.steer_angle_rad), std::end(command.steer_angle_rad), finite);
}

double since_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void warn(Utime t, const std::string& event) {
  std::printf("%lld WARN rover_simulator %s\n", static_cast<long long>(t), event.c_str());
  std::fflush(stdout);
}

RoverPhase phase_of(const supervisor_state_t& state) {
  switch (state.state) {
    case supervisor_state_t::GOAL_REACHED:
      return RoverPhase::kArrived;
    case supervisor_state_t::SAFE:
      // The operator may clear an emergency stop.
      return state.cause == "emergency_stop" ? RoverPhase::kFaultStop : RoverPhase::kGivenUp;
    case supervisor_state_t::FAULT_STOP:
      return state.cause == "no_path" ? RoverPhase::kGivenUp : RoverPhase::kFaultStop;
    default:
      return RoverPhase::kDriving;
  }
}

}  // namespace

Simulator::Simulator(const SimulatorOptions& options, SimulatedRover& rover, lcm::LCM& lcm, lcm::LCM* reports,
                     InProcess in_process)
    : options_(options),
      rover_(rover),
      lcm_(lcm),
      reports_(reports == nullptr ? lcm : *reports),
      in_process_(std::move(in_process)),
      streams_("rover_simulator", options.boot_id),
      barrier_(options.participants),
      end_(options.end, kFirstTick),
      wheel_commands_(channel::kWheelCommand),
      ptu_commands_(channel::kPtuCommand),
      loccam_{channel::kLocCamLeft, channel::kLocCamRight, SensorFaultModel::StereoPair::kLocCam},
      navcam_{channel::kNavCamLeft, channel::kNavCamRight, SensorFaultModel::StereoPair::kNavCam},
      script_(options.faults, kFirstTick),
      last_counted_position_(rover.T_map_body().translation().head<2>()) {
  const auto listen = [this](lcm::LCM& bus, const char* channel, auto handler) {
    malformed_[channel] = 0;
    auto* subscription = bus.subscribe(channel, handler, this);
    subscription->setQueueCapacity(0);
  };
  listen(reports_, channel::kDone, &Simulator::on_done);
  listen(lcm_, channel::kWheelCommand, &Simulator::on_command<wheel_command_t, &Simulator::wheel_commands_>);
  if (rover_.pan_tilt() != nullptr)
    listen(lcm_, channel::kPtuCommand, &Simulator::on_command<ptu_command_t, &Simulator::ptu_commands_>);
  listen(lcm_, channel::kState, &Simulator::on_state);
  if (options_.allow_injection) listen(lcm_, channel::kInject, &Simulator::on_inject);
}

void Simulator::count_malformed(const std::string& channel) {
  const std::int64_t count = ++malformed_[channel];
  if ((count & (count - 1)) == 0) warn(now_, "BAD_MESSAGE channel=" + channel + " count=" + std::to_string(count));
}

void Simulator::on_done(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  done_t done{};
  if (!decode(buffer, channel, done)) return;
  const header_t& header = done.header;
  if (done.lost > 0) summary_.deterministic = false;
  if (done.tick_utime == kNever) return barrier_.ready(header.publisher, header.boot_id, done.pid);
  barrier_.done(header.publisher, header.boot_id, done.pid, done.tick_utime, done.promise_utime, done.busy != 0);
  for (const stream_seq_t& stream : done.streams)
    if (malformed_.contains(stream.channel)) awaited_streams_.push_back(stream);
  pending_done_.push_back(done);
}

// Streams of DONE messages released by t. Filtering by release time, not arrival, keeps the run deterministic.
std::vector<stream_seq_t> Simulator::take_released_streams(Utime t) {
  std::vector<stream_seq_t> streams;
  std::erase_if(pending_done_, [&](const done_t& done) {
    if (done.header.release_utime > t) return false;
    streams.insert(streams.end(), done.streams.begin(), done.streams.end());
    return true;
  });
  return streams;
}

template <class Command, CommandInbox<Command> Simulator::*inbox>
void Simulator::on_command(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  Command command{};
  if (!decode(buffer, channel, command) || !ledger_.arrived(channel, command.header)) return;
  (this->*inbox).add(command);
}

void Simulator::on_state(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  supervisor_state_t state{};
  if (!decode(buffer, channel, state) || !ledger_.arrived(channel, state.header)) return;
  states_.push_back(state);
}

SimulationSummary Simulator::run(const std::function<bool()>& running) {
  if (!wait_for_start(running)) return summary_;
  const auto started = Clock::now();
  Utime t = kFirstTick;
  for (; running(); t = next_tick(t, running)) {
    now_ = t;
    if (const auto outcome = end_.outcome_at(t)) {
      summary_.outcome = *outcome;
      if (!options_.realtime)
        wait_for_barrier(t, running);  // the services finish the last tick before they are stopped
      break;
    }
    apply_faults(t, running);
    if (t > kFirstTick) step_world(t);
    publish_sensors(t);
    start_exposures(t);
    publish_due_images(loccam_, t);
    publish_due_images(navcam_, t);
    if (options_.realtime)
      std::this_thread::sleep_until(started + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                                  to_seconds(t - jumped_ - kFirstTick) / options_.pace)));
    else
      wait_for_barrier(t, running);
    publish_tick(t);
    process_states(t, running);
  }
  if (summary_.outcome.empty()) summary_.outcome = "stopped";
  if (options_.realtime) summary_.deterministic = false;
  summary_.simulated_s = to_seconds(t - kFirstTick);
  summary_.wall_s = since_s(started);
  return summary_;
}

// In lockstep, all messages released by t have arrived.
void Simulator::process_states(Utime t, const std::function<bool()>& running) {
  while (lcm_.handleTimeout(0) > 0) {
  }
  if (options_.realtime)
    while (reports_.handleTimeout(0) > 0) {
    }
  while (!states_.empty() && states_.front().header.release_utime <= t) {
    end_.phase(phase_of(states_.front()), states_.front().header.utime);
    script_.entered(states_.front().state);
    run_full_services(states_.front().full_stopped == 0, t, running);
    states_.pop_front();
  }
}

// The supervisor stops and starts their processes. In one process they only become idle.
void Simulator::run_full_services(bool run, Utime t, const std::function<bool()>& running) {
  if (in_process_.run_services || std::exchange(full_services_run_, run) == run) return;
  for (const std::string& name : barrier_.participants()) {
    if (!is_full_service(name)) continue;
    if (run) {
      barrier_.expect(name, t, kRejoinDelay);
      continue;
    }
    if (!options_.realtime && !wait_until_idle(name, running)) summary_.deterministic = false;
    barrier_.stop(name);
  }
}

bool Simulator::poll_reports(int timeout_ms) {
  return in_process_.run_services ? in_process_.run_services() : reports_.handleTimeout(timeout_ms) > 0;
}

bool Simulator::wait_for_start(const std::function<bool()>& running) {
  const auto started = Clock::now();
  const auto missing_now = [&] { return barrier_.waiting_for(kFirstTick); };
  while (running() && !missing_now().empty() && since_s(started) < kStartTimeout_s) poll_reports(20);
  const std::vector<std::string> missing = missing_now();
  if (missing.empty()) return running();
  summary_.outcome = "not_started";
  for (const std::string& name : missing) summary_.left.push_back(name + " did not start");
  return false;
}

WheelCommand Simulator::command_at(Utime t) {
  if (auto newest = wheel_commands_.take(t, injector_.get())) command_ = std::move(newest);
  if (!command_ || command_->valid_until_utime < t || !all_finite(*command_)) return rover_.hold_command();
  return wheel_command_from(*command_);
}

// A clock-step fault makes message time jump; all services must be idle then.
Utime Simulator::next_tick(Utime t, const std::function<bool()>& running) {
  const Utime jump = world_faults_.take_clock_step();
  if (jump == 0) return t + kTickUs;
  jumped_ += jump;
  if (!options_.realtime)
    for (const std::string& service : barrier_.participants()) wait_until_idle(service, running);
  barrier_.allow_until(t + kTickUs + jump);
  return t + kTickUs + jump;
}

void Simulator::step_world(Utime t) {
  move_pan_tilt(t - kTickUs);
  rover_.set_faults(world_faults_.vehicle(t));
  rover_.advance(to_seconds(kTickUs), command_at(t - kTickUs));
  update_driven_distance();
}

void Simulator::publish_sensors(Utime t) {
  const bool expired = command_ && command_->valid_until_utime < t;
  imu_t imu = imu_message(sensors_.imu(sensor_faults_, rover_.imu()));
  wheel_state_t wheels = wheel_state_message(sensors_.wheels(sensor_faults_, rover_.wheels()), expired);
  truth_t truth = truth_message(rover_.truth());
  if (!sensor_faults_.imu_dead) publish(channel::kImu, imu, t, t);
  publish(channel::kWheelState, wheels, t, t);
  publish(channel::kTruth, truth, t, t);
  publish_pan_tilt(t);
}

// A new command replaces the previous one and its image request.
void Simulator::move_pan_tilt(Utime t) {
  if (const auto newest = ptu_commands_.take(t, injector_.get())) {
    rover_.pan_tilt()->command(pan_tilt_command_from(*newest));
    ptu_enabled_ = true;
  }
}

// Silent until the first command, so drives without the NavCam have no overhead.
void Simulator::publish_pan_tilt(Utime t) {
  if (!ptu_enabled_) return;
  ptu_state_t state = ptu_state_message(rover_.pan_tilt()->state());
  publish(channel::kPtuState, state, t, t);
}

void Simulator::start_exposures(Utime t) {
  if ((t - kFirstTick) % kLocCamPeriod == 0) {
    const Eigen::Isometry3d T_map_left = rover_.T_map_loccam();
    if (in_process_.loccam)
      in_process_.loccam(t, T_map_left);
    else
      expose(loccam_, t, [=, this](std::int64_t frame) { return rover_.expose_loccam(T_map_left, frame); });
  }
  PanTiltSim* unit = rover_.pan_tilt();
  if (unit == nullptr || !unit->image_due() || navcam_.exposure) return;
  unit->image_taken();
  const Eigen::Isometry3d T_map_left = rover_.T_map_navcam();
  if (in_process_.navcam)
    in_process_.navcam(t, T_map_left);
  else
    expose(navcam_, t, [=, this](std::int64_t frame) { return rover_.expose_navcam(T_map_left, frame); });
}

void Simulator::expose(Camera& camera, Utime t, Render render) {
  if (camera.exposure) publish_due_images(camera, camera.exposure->release);
  if (camera.exposure) return;  // real time only: rendering is late, skip this exposure
  PendingPair pending{t, t + kCameraLatency, {}};
  pending.pair = std::async(std::launch::async, std::move(render), camera.frames++);
  camera.exposure = std::move(pending);
}

void Simulator::publish_due_images(Camera& camera, Utime t) {
  if (!camera.exposure || camera.exposure->release > t) return;
  PendingPair& pending = *camera.exposure;
  const bool finished = pending.pair.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (options_.realtime && !finished) {
    pending.release = t + kTickUs;  // real time only: rendering is late
    return;
  }
  const StereoCameraSim::Pair pair =
      sensors_.images(world_faults_.sensors(pending.utime), camera.stereo_pair, pending.pair.get());
  publish_image(camera.left_channel, pair.left, pair.exposure_s, pending);
  publish_image(camera.right_channel, pair.right, pair.exposure_s, pending);
  camera.exposure.reset();
}

void Simulator::publish_image(const char* channel, const GrayImage& image, double exposure_s,
                              const PendingPair& pending) {
  image_t message = image_message(image, exposure_s);
  publish(channel, message, pending.utime, pending.release);
}

void Simulator::wait_for_barrier(Utime t, const std::function<bool()>& running) {
  auto started = Clock::now();
  double asked_at_s = 0.0;
  cpu_s_.clear();
  for (auto missing = barrier_.waiting_for(t); !missing.empty() && running(); missing = barrier_.waiting_for(t)) {
    if (poll_reports(5)) continue;
    const double waited_s = since_s(started);
    handle_missing(missing, t, waited_s);
    if (waited_s - asked_at_s < kResendPeriod_s || last_tick_.empty()) continue;
    asked_at_s = waited_s;
    for (const std::string& name : missing) cpu_s_.try_emplace(name, process_cpu_s(barrier_.pid_of(name)));
    lcm_.publish(channel::kTick, last_tick_.data(), static_cast<unsigned int>(last_tick_.size()));
  }
  wait_for_listed_messages(running);
}

// DONE arrives on its own socket and may overtake the messages that it lists.
void Simulator::wait_for_listed_messages(const std::function<bool()>& running) {
  const auto started = Clock::now();
  const auto here = [this](const stream_seq_t& stream) { return ledger_.complete(stream); };
  while (std::erase_if(awaited_streams_, here), !awaited_streams_.empty() && running()) {
    if (lcm_.handleTimeout(1) > 0 || since_s(started) < kLostMessageTimeout_s) continue;
    summary_.deterministic = false;
    for (const stream_seq_t& stream : awaited_streams_) {
      ledger_.give_up(stream);
      warn(now_, "LOST_ON_BUS channel=" + stream.channel + " publisher=" + stream.publisher);
    }
    awaited_streams_.clear();
  }
}

// A process that uses CPU time is not silent; wall time must not change the run.
bool Simulator::is_computing(const std::string& name, double waited_s) const {
  const auto before = cpu_s_.find(name);
  if (before == cpu_s_.end() || waited_s >= kBusyTimeout_s) return false;
  return process_cpu_s(barrier_.pid_of(name)) - before->second > kMinBusyCpuShare * waited_s;
}

// A dead process leaves the barrier at once, a silent one after a timeout; both may rejoin. What it did of its last
// tick depends on wall time, unlike that of a process which the scenario killed: such a one has left before.
void Simulator::handle_missing(const std::vector<std::string>& missing, Utime t, double waited_s) {
  for (const std::string& name : missing) {
    if (!barrier_.takes_part(name) && waited_s >= kSilenceTimeout_s) {
      summary_.deterministic = false;
      summary_.left.push_back(name + " did not return until " + std::to_string(to_seconds(t)) + " s");
      warn(t, "NOT_BACK service=" + name);
      barrier_.give_up(name);
      continue;
    }
    const bool dead = barrier_.pid_of(name) > 0 && !process_alive(barrier_.pid_of(name));
    if (!dead && (waited_s < kSilenceTimeout_s || is_computing(name, waited_s))) continue;
    summary_.deterministic = false;
    summary_.left.push_back(name + (dead ? " died at " : " silent at ") + std::to_string(to_seconds(t)) + " s");
    warn(t, "LEFT_BARRIER service=" + name + " dead=" + std::to_string(static_cast<int>(dead)));
    barrier_.leave(name, dead ? Barrier::Cause::kDied : Barrier::Cause::kSilent, t, kRejoinDelay);
  }
}

void Simulator::publish_tick(Utime t) {
  tick_t tick{};
  tick.mode = options_.realtime ? tick_t::REALTIME : tick_t::LOCKSTEP;
  tick.members = members_ = barrier_.admit(t);
  tick.member_count = static_cast<std::int32_t>(tick.members.size());
  tick.streams = streams_.take_updated();
  const std::vector<stream_seq_t> streams = take_released_streams(t);
  tick.streams.insert(tick.streams.end(), streams.begin(), streams.end());
  std::sort(tick.streams.begin(), tick.streams.end(), [](const stream_seq_t& a, const stream_seq_t& b) {
    return std::tie(a.channel, a.publisher, a.boot_id, a.seq) < std::tie(b.channel, b.publisher, b.boot_id, b.seq);
  });
  tick.stream_count = static_cast<std::int32_t>(tick.streams.size());
  tick.header = streams_.next(channel::kTick, t, t);
  last_tick_ = encoded(tick);
  lcm_.publish(channel::kTick, last_tick_.data(), static_cast<unsigned int>(last_tick_.size()));
}

}  // namespace rover
