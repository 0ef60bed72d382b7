#include "tools/launcher/inject_command.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <rover/injection_t.hpp>
#include <rover/tick_t.hpp>
#include <thread>

#include "common/bus/channels.hpp"
#include "common/bus/child_process.hpp"
#include "common/bus/faults.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/streams.hpp"
#include "common/core/time.hpp"
#include "tools/status/running_run.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

FaultRequest request_of(const InjectArguments& arguments, const FaultKind& kind) {
  FaultRequest request{arguments.fault, arguments.target, arguments.amount};
  if (request.target.empty() && kind.targets.size() == 1) request.target = kind.targets.front();
  if (request.target.empty())
    throw ConfigError("inject " + kind.name + ": a target is required; see ./rover inject --list");
  if (std::string problem = target_problem(kind, request.target, find_channel_type); !problem.empty())
    throw ConfigError("inject " + kind.name + ": " + problem);
  if (std::isnan(request.amount)) request.amount = kind.default_amount;
  if (std::isnan(request.amount)) throw ConfigError("inject " + kind.name + ": --amount is required, in " + kind.unit);
  if (std::string problem = amount_problem(kind, request.amount); !problem.empty())
    throw ConfigError("inject " + kind.name + ": --amount: " + problem);
  if (std::isnan(arguments.for_s)) return request;
  if (!kind.has_duration) throw ConfigError("inject " + kind.name + ": --for: this fault has no duration");
  if (!(arguments.for_s > 0.0 && arguments.for_s < 1e6)) throw ConfigError("inject: --for: out of range (0, 1e6) s");
  request.for_s = arguments.for_s;
  return request;
}

struct LiveRun {
  std::string dir;
  std::string bus;
  bool allow_injection = false;
};

std::string newest_live(const std::string& logs) {
  const auto newest = status::newest_running(logs);
  if (!newest) throw ConfigError("inject: no run is active in " + logs + "; select one with --run");
  return *newest;
}

LiveRun find_run(const InjectArguments& arguments) {
  const fs::path dir = arguments.run_dir.empty() ? newest_live(arguments.source_dir + "/logs") : arguments.run_dir;
  std::ifstream in(dir / "launch.json");
  const auto facts = nlohmann::json::parse(in, nullptr, false);
  if (!facts.is_object() || !status::is_running(dir))
    throw ConfigError("inject: " + dir.string() + ": no run is active there");
  const LiveRun run{fs::absolute(dir), facts.value("bus", ""), facts.value("allow_injection", false)};
  if (!run.allow_injection)
    throw ConfigError("inject: " + run.dir +
                      " was started without injection; start it with: ./rover run --allow-injection");
  return run;
}

void signal_through_s6(const LiveRun& run, const std::string& service, const char* option) {
  if (!keeps_service(run.dir, service)) throw ConfigError("inject: this run has no service " + service);
  if (!control_service(run.dir, service, option)) throw ConfigError("inject: s6-svc failed on " + service);
}

int pid_of(const LiveRun& run, const std::string& service) {
  const auto output = output_of({"s6-svstat", "-o", "pid", run.dir + "/services/" + service});
  return output ? std::atoi(output->c_str()) : -1;
}

// Each kill waits for a new process, which s6 starts after up to 1 s.
void kill_repeatedly(const LiveRun& run, const std::string& service, int times) {
  constexpr auto kTimeout = std::chrono::seconds(20);
  for (int i = 0; i < times; ++i) {
    const int killed_pid = pid_of(run, service);
    signal_through_s6(run, service, "-k");
    const auto until = Clock::now() + kTimeout;
    for (int pid = killed_pid; i + 1 < times && (pid == killed_pid || pid <= 0); pid = pid_of(run, service)) {
      if (Clock::now() > until) throw ConfigError("inject: " + service + " was not restarted");
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

void inject_process_fault(const LiveRun& run, const FaultRequest& request) {
  if (request.fault == "hang") return signal_through_s6(run, request.target, "-p");
  kill_repeatedly(run, request.target, request.fault == "restart_loop" ? static_cast<int>(request.amount) : 1);
}

// Message time of the next tick on the bus.
Utime listen_for_time(lcm::LCM& bus) {
  Utime now = kNever;
  bus.subscribeFunction(
      channel::kTick,
      +[](const lcm::ReceiveBuffer* buffer, const std::string&, Utime* time) {
        tick_t tick;
        if (decode_message(buffer->data, static_cast<int>(buffer->data_size), tick)) *time = tick.header.utime;
      },
      &now);
  const auto until = Clock::now() + std::chrono::seconds(20);
  while (now == kNever && Clock::now() < until) bus.handleTimeout(100);
  if (now == kNever) throw ConfigError("inject: no TICK on the bus for 20 s");
  return now;
}

void publish_injection(const LiveRun& run, const FaultRequest& request) {
  lcm::LCM bus(run.bus);
  if (!bus.good()) throw ConfigError("bus: cannot join " + run.bus);
  const Utime now = listen_for_time(bus);
  injection_t injection{};
  // Increasing, so that no receiver treats it as a repetition.
  const std::int64_t id =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count();
  injection.header.utime = injection.header.release_utime = now;
  injection.header.seq = 1;
  injection.header.publisher = "inject";
  injection.header.boot_id = injection.injection_id = id;
  injection.fault = request.fault;
  injection.target = request.target;
  injection.amount = request.amount;
  injection.from_utime = now;
  injection.until_utime =
      std::isfinite(request.for_s) ? now + to_utime(request.for_s) : std::numeric_limits<Utime>::max();
  if (bus.publish(channel::kInject, &injection) != 0) throw ConfigError("bus: cannot send on " + run.bus);
}

}  // namespace

int inject(const InjectArguments& arguments) {
  if (arguments.list) {
    std::printf("%s", fault_list().c_str());
    return 0;
  }
  const FaultKind* kind = find_fault(arguments.fault);
  if (arguments.fault.empty()) throw ConfigError("inject: no fault given; see ./rover inject --list");
  if (kind == nullptr) throw ConfigError("inject: '" + arguments.fault + "' is not a fault; see ./rover inject --list");
  const FaultRequest request = request_of(arguments, *kind);
  const LiveRun run = find_run(arguments);
  if (kind->on == FaultTarget::kService)
    inject_process_fault(run, request);
  else
    publish_injection(run, request);
  std::printf("injected %s on %s in %s\n", request.fault.c_str(), request.target.c_str(), run.dir.c_str());
  return 0;
}

}  // namespace rover
