// Fault injection of the simulator. Faults begin at ticks, so runs remain deterministic.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/bus/channels.hpp"
#include "common/core/frames.hpp"
#include "rover_simulator/simulator.hpp"

namespace rover {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kIdleTimeout_s = 10.0;
constexpr double kMinStepM = 0.01;  // smaller moves are noise of a stationary rover

injection_t injection_of(const FaultRequest& order, std::int64_t id, Utime now) {
  injection_t injection{};
  injection.injection_id = id;
  injection.fault = order.fault;
  injection.target = order.target;
  injection.amount = order.amount;
  injection.from_utime = now;
  injection.until_utime = std::isfinite(order.for_s) ? now + to_utime(order.for_s) : std::numeric_limits<Utime>::max();
  return injection;
}

}  // namespace

void Simulator::on_inject(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  injection_t injection{};
  if (!decode(buffer, channel, injection)) return;
  const bool own = injection.header.publisher == streams_.publisher();
  if (!own && ledger_.arrived(channel, injection.header)) requested_.push_back(injection);
}

void Simulator::apply_faults(Utime t, const std::function<bool()>& running) {
  begin_scripted(t);
  begin_requested(t);
  republish_active_faults(t);
  sensor_faults_ = world_faults_.sensors(t);
  for (const ProcessSignal& order : process_faults_.take_due(barrier_)) send_signal(order, t, running);
}

void Simulator::begin_scripted(Utime t) {
  for (const FaultRequest& order : script_.take_due(t, driven_m_)) {
    injection_t injection = injection_of(order, ++injections_, t);
    publish(channel::kInject, injection, t, t);
    const FaultKind& kind = *find_fault(order.fault);
    if (kind.has_duration) announced_.push_back(injection);
    if (kind.on == FaultTarget::kService) process_faults_.order(order);
    begin(injection);
  }
}

// Process faults of other publishers are not handled here; they use s6.
void Simulator::begin_requested(Utime t) {
  std::erase_if(requested_, [&](const injection_t& injection) {
    if (injection.header.release_utime > t) return false;
    summary_.deterministic = false;
    begin(injection);
    return true;
  });
}

void Simulator::begin(const injection_t& injection) {
  const FaultKind* kind = find_fault(injection.fault);
  const bool valid = kind != nullptr && amount_problem(*kind, injection.amount).empty();
  std::printf("%lld WARN rover_simulator INJECTED fault=%s target=%s amount=%g known=%d\n",
              static_cast<long long>(now_), injection.fault.c_str(), injection.target.c_str(), injection.amount, valid);
  std::fflush(stdout);
  if (!valid) return;
  if (!injector_) injector_ = std::make_unique<FaultInjector>(streams_.publisher());
  injector_->inject(injection);
  if (kind->on == FaultTarget::kWorld && target_problem(*kind, injection.target, find_channel_type).empty())
    world_faults_.begin(injection, yaw_of(rover_.T_map_body()));
}

// Republishes active faults for processes that joined at the last tick.
void Simulator::republish_active_faults(Utime t) {
  const bool joined = std::any_of(members_.begin(), members_.end(), [this](const std::string& name) {
    return std::find(informed_members_.begin(), informed_members_.end(), name) == informed_members_.end();
  });
  informed_members_ = members_;
  if (!joined) return;
  std::erase_if(announced_, [t](const injection_t& injection) { return injection.until_utime < t; });
  for (injection_t& injection : announced_)
    if (injection.from_utime < t) publish(channel::kInject, injection, t, t);
}

void Simulator::send_signal(const ProcessSignal& order, Utime t, const std::function<bool()>& running) {
  // In lockstep the service must have finished the previous tick, so the effect depends on message time only.
  if (!options_.realtime && !wait_until_idle(order.service, running)) summary_.deterministic = false;
  const int pid = barrier_.pid_of(order.service);
  if (pid > 0) kill(pid, order.signal);
  barrier_.leave(order.service, Barrier::Cause::kDied, t, order.absence);
  const char* what = order.signal == SIGSTOP ? " stopped at " : " killed at ";
  summary_.left.push_back(order.service + what + std::to_string(to_seconds(t)) + " s by the scenario");
}

bool Simulator::wait_until_idle(const std::string& service, const std::function<bool()>& running) {
  const auto until = Clock::now() + std::chrono::duration<double>(kIdleTimeout_s);
  while (!barrier_.idle(service) && running() && Clock::now() < until) poll_reports(5);
  return barrier_.idle(service);
}

void Simulator::update_driven_distance() {
  const Eigen::Vector2d here = rover_.T_map_body().translation().head<2>();
  const double moved_m = (here - last_counted_position_).norm();
  if (moved_m < kMinStepM) return;
  driven_m_ += moved_m;
  last_counted_position_ = here;
}

}  // namespace rover
