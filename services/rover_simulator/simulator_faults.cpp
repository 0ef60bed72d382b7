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

constexpr double kPatience_s = 10.0;
constexpr double kWayStepM = 0.01;  // smaller moves are noise of a stationary rover

injection_t injection_of(const FaultOrder& order, std::int64_t id, Utime now) {
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
  if (!own && ledger_.arrived(channel, injection.header)) asked_for_.push_back(injection);
}

void Simulator::do_faults(Utime t, const std::function<bool()>& running) {
  begin_scripted(t);
  begin_asked_for(t);
  announce_again(t);
  broken_ = world_faults_.sensors(t);
  for (const ProcessBlow& blow : process_faults_.take_due(barrier_)) deal(blow, t, running);
}

void Simulator::begin_scripted(Utime t) {
  for (const FaultOrder& order : script_.take_due(t, driven_m_)) {
    injection_t injection = injection_of(order, ++injections_, t);
    publish(channel::kInject, injection, t, t);
    const FaultKind& kind = *find_fault(order.fault);
    if (kind.lasts) announced_.push_back(injection);
    if (kind.on == FaultTarget::kService) process_faults_.order(order);
    begin(injection);
  }
}

// Process faults of other publishers are not handled here; they use s6.
void Simulator::begin_asked_for(Utime t) {
  std::erase_if(asked_for_, [&](const injection_t& injection) {
    if (injection.header.release_utime > t) return false;
    summary_.deterministic = false;
    begin(injection);
    return true;
  });
}

void Simulator::begin(const injection_t& injection) {
  const FaultKind* kind = find_fault(injection.fault);
  const bool sound = kind != nullptr && amount_problem(*kind, injection.amount).empty();
  std::printf("%lld WARN rover_simulator INJECTED fault=%s target=%s amount=%g known=%d\n",
              static_cast<long long>(now_), injection.fault.c_str(), injection.target.c_str(), injection.amount, sound);
  std::fflush(stdout);
  if (!sound) return;
  if (!tap_) tap_ = std::make_unique<Tap>(streams_.publisher());
  tap_->inject(injection);
  if (kind->on == FaultTarget::kWorld && target_problem(*kind, injection.target, find_channel_type).empty())
    world_faults_.begin(injection, yaw_of(rover_.T_map_body()));
}

// Republishes active faults for processes that joined at the last tick.
void Simulator::announce_again(Utime t) {
  const bool joined = std::any_of(members_.begin(), members_.end(), [this](const std::string& name) {
    return std::find(told_.begin(), told_.end(), name) == told_.end();
  });
  told_ = members_;
  if (!joined) return;
  std::erase_if(announced_, [t](const injection_t& injection) { return injection.until_utime < t; });
  for (injection_t& injection : announced_)
    if (injection.from_utime < t) publish(channel::kInject, injection, t, t);
}

void Simulator::deal(const ProcessBlow& blow, Utime t, const std::function<bool()>& running) {
  // In lockstep the service must have finished the previous tick, so the effect depends on message time only.
  if (!options_.realtime && !wait_until_idle(blow.service, running)) summary_.deterministic = false;
  const int pid = barrier_.pid_of(blow.service);
  if (pid > 0) kill(pid, blow.signal);
  barrier_.leave(blow.service, Barrier::Cause::kDied, t, blow.away);
  const char* what = blow.signal == SIGSTOP ? " stopped at " : " killed at ";
  summary_.left.push_back(blow.service + what + std::to_string(to_seconds(t)) + " s by the scenario");
}

bool Simulator::wait_until_idle(const std::string& service, const std::function<bool()>& running) {
  const auto until = Clock::now() + std::chrono::duration<double>(kPatience_s);
  while (!barrier_.idle(service) && running() && Clock::now() < until) reports_.handleTimeout(5);
  return barrier_.idle(service);
}

void Simulator::measure_way() {
  const Eigen::Vector2d here = rover_.T_map_body().translation().head<2>();
  const double moved_m = (here - way_mark_).norm();
  if (moved_m < kWayStepM) return;
  driven_m_ += moved_m;
  way_mark_ = here;
}

}  // namespace rover
