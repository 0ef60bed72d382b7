#include "tools/one_process/stack.hpp"

#include <chrono>

#include "common/core/check.hpp"

namespace rover {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

void Stack::add(const std::string& service, Factory factory) {
  processes_.push_back(std::make_unique<Process>());
  processes_.back()->name = service;
  processes_.back()->factory = std::move(factory);
}

Stack::Process& Stack::find(const std::string& service) {
  for (const auto& process : processes_)
    if (process->name == service) return *process;
  ROVER_CHECK(false, service);
  return *processes_.front();
}

void Stack::start(Process& process) {
  NodeOptions options;
  options.name = process.name;
  options.boot_id = ++process.boots;
  options.run_dir = run_dir_;
  options.allow_injection = allow_injection_;
  options.cpu_scale = cpu_scale_;
  process.node = std::make_unique<Node>(options, bus_);
  process.service = process.factory(*process.node);
}

void Stack::kill(const std::string& service, double away_s) {
  Process& process = find(service);
  if (process.stuck) return;
  process.service = nullptr;
  process.node = nullptr;
  process.hangs = false;
  process.back_at = now_ + to_utime(away_s);
}

void Stack::set_status(const std::string& service, std::int8_t status) {
  Process& process = find(service);
  process.status = status;
  if (process.node && status == heartbeat_t::OK) process.node->set_status(status, "");
}

void Stack::start() {
  for (const auto& process : processes_) {
    start(*process);
    process->node->announce();
  }
}

bool Stack::drain() {
  bool any = false;
  while (bus_.handleTimeout(0) > 0) any = true;
  return any;
}

bool Stack::work() {
  const bool any = drain();
  for (const auto& process : processes_) {
    if (!process->node || process->hangs) continue;
    const auto started = Clock::now();
    process->node->handle(0);
    seconds_[process->name] += std::chrono::duration<double>(Clock::now() - started).count();
  }
  return drain() || any;
}

void Stack::tick(Utime now) {
  now_ = now;
  tick_t tick{};
  tick.header = ticks_.next(channel::kTick, now, now);
  tick.mode = tick_t::LOCKSTEP;
  for (const auto& process : processes_) {
    if (!process->node && process->back_at <= now) start(*process);
    if (process->node && process->status != heartbeat_t::OK) process->node->set_status(process->status, "injected");
    if (process->node && !process->hangs) tick.members.push_back(process->name);
  }
  tick.member_count = static_cast<std::int32_t>(tick.members.size());
  bus_.publish(channel::kTick, &tick);
  work();
}

}  // namespace rover
