// Kills the services of a real-time run one after the other while the rover drives, and measures their restart times on
// the bus; finally the simulator, the clock master. One line of JSON per kill.
//   restart_probe RUN_DIR BUS_URL ROUNDS
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <string>

#include "common/bus/channels.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

using Clock = std::chrono::steady_clock;
using Wall = Clock::time_point;

constexpr double kSteadyS = 13.0;   // driving time before each kill: five stops within ten metres would end the drive
constexpr double kTimeoutS = 30.0;  // timeout for the restart and for driving again
constexpr double kGiveUpS = 120.0;  // without motion the run has ended
constexpr double kTurningRadps = 0.5;

double seconds(Wall from, Wall to) {
  return std::chrono::duration<double>(to - from).count();
}

// Newest messages of the rover.
class Subscriber {
 public:
  explicit Subscriber(lcm::LCM& bus) : bus_(bus) { bus.subscribe(".*", &Subscriber::receive, this); }

  bool listen() { return bus_.handleTimeout(20) >= 0; }
  int pid(const std::string& service) const { return pids_.contains(service) ? pids_.at(service) : 0; }
  std::int64_t boot(const std::string& service) const { return boots_.contains(service) ? boots_.at(service) : 0; }
  bool permitted() const { return permitted_; }
  double wheel_radps() const { return wheel_radps_; }
  Utime wheel_utime() const { return wheel_utime_; }
  // Wall time since the rover started to drive; 0 while it does not.
  double driving_s() const { return driving_ ? seconds(driving_since_, Clock::now()) : 0.0; }

 private:
  void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    header_t header{};
    if (!peek_header(buffer->data, static_cast<int>(buffer->data_size), header)) return;
    boots_[header.publisher] = std::max(boots_[header.publisher], header.boot_id);
    if (channel == channel::kHeartbeat) take<heartbeat_t>(buffer, [this](const auto& m) { pids_[m.service] = m.pid; });
    if (channel == channel::kDrivePermit) take<drive_permit_t>(buffer, [this](const auto& m) { note(m); });
    if (channel == channel::kWheelCommand) take<wheel_command_t>(buffer, [this](const auto& m) { note(m); });
  }
  template <class Message, class Then>
  void take(const lcm::ReceiveBuffer* buffer, Then then) {
    Message message;
    if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) then(message);
  }
  void note(const drive_permit_t& m) { permitted_ = m.granted == 1; }
  void note(const wheel_command_t& m) {
    wheel_radps_ = 0.0;
    for (const double rate : m.drive_rate_radps) wheel_radps_ = std::max(wheel_radps_, std::abs(rate));
    wheel_utime_ = m.header.utime;
    const bool driving = permitted_ && wheel_radps_ > kTurningRadps;
    if (driving && !driving_) driving_since_ = Clock::now();
    driving_ = driving;
  }

  lcm::LCM& bus_;
  std::map<std::string, int> pids_;
  std::map<std::string, std::int64_t> boots_;
  bool permitted_ = false;
  double wheel_radps_ = 0.0;
  Utime wheel_utime_ = kNever;
  bool driving_ = false;
  Wall driving_since_;
};

bool wait_until_driving(Subscriber& subscriber) {
  for (const Wall begin = Clock::now(); seconds(begin, Clock::now()) < kGiveUpS;) {
    if (!subscriber.listen()) return false;
    if (std::min(subscriber.driving_s(), seconds(begin, Clock::now())) > kSteadyS) return true;
  }
  return false;
}

// Message time from the kill until the wheel command decreases, and until it is zero; -1: never.
struct Stop {
  double begun_s = -1.0;
  double still_s = -1.0;
};

nlohmann::json kill_and_measure(Subscriber& subscriber, const std::string& service) {
  const std::int64_t boot_before = subscriber.boot(service);
  const Utime utime = subscriber.wheel_utime();
  const double rate_before = subscriber.wheel_radps();
  const Wall killed = Clock::now();
  kill(subscriber.pid(service), SIGKILL);
  double first_message_s = -1.0, drives_again_s = -1.0;
  Stop stop;
  while (seconds(killed, Clock::now()) < kTimeoutS && drives_again_s < 0.0 && subscriber.listen()) {
    const double since_s = seconds(killed, Clock::now());
    if (first_message_s < 0.0 && subscriber.boot(service) > boot_before) first_message_s = since_s;
    const double command_s = to_seconds(subscriber.wheel_utime() - utime);
    if (stop.begun_s < 0.0 && subscriber.wheel_radps() < 0.9 * rate_before) stop.begun_s = command_s;
    if (stop.still_s < 0.0 && subscriber.wheel_radps() < 1e-3) stop.still_s = command_s;
    if (first_message_s >= 0.0 && subscriber.driving_s() > 0.5) drives_again_s = since_s - 0.5;
  }
  return {{"service", service},
          {"first_message_s", first_message_s},
          {"stop_begun_s", stop.begun_s},
          {"still_s", stop.still_s},
          {"drives_again_s", drives_again_s}};
}

// Kills the clock master. Returns the wall time until the permit is withdrawn.
nlohmann::json kill_simulator(Subscriber& subscriber, const std::string& run_dir) {
  const Wall killed = Clock::now();
  const bool done = kill_service(run_dir, "rover_simulator");
  double withdrawn_s = -1.0;
  while (done && withdrawn_s < 0.0 && seconds(killed, Clock::now()) < 5.0 && subscriber.listen())
    if (!subscriber.permitted()) withdrawn_s = seconds(killed, Clock::now());
  return {{"service", "rover_simulator"}, {"withdrawn_s", withdrawn_s}};
}

int probe(const std::string& run_dir, const std::string& url, int rounds) {
  lcm::LCM bus(url);
  if (!bus.good()) return 1;
  Subscriber subscriber(bus);
  for (int round = 0; round < rounds; ++round)
    for (const char* service : kServiceNames) {
      if (!wait_until_driving(subscriber)) return 0;  // the goal, most likely
      std::printf("%s\n", kill_and_measure(subscriber, service).dump().c_str());
      std::fflush(stdout);
    }
  if (wait_until_driving(subscriber)) std::printf("%s\n", kill_simulator(subscriber, run_dir).dump().c_str());
  return 0;
}

}  // namespace
}  // namespace rover

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: restart_probe RUN_DIR BUS_URL ROUNDS\n");
    return 2;
  }
  return rover::probe(argv[1], argv[2], std::atoi(argv[3]));
}
