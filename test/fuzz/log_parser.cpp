#include <rover/ground_command_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"
#include "common/bus/streams.hpp"
#include "corpus.hpp"
#include "parsers.hpp"
#include "tools/interchange/export_log.hpp"
#include "tools/repair/repair.hpp"
#include "tools/replay/recorded_log.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/spy/traffic.hpp"

namespace rover::fuzz {
namespace {

namespace fs = std::filesystem;

// A log as LCM writes it.
class LogBytes {
 public:
  template <class Message>
  void add(const char* channel, Message message, Utime t) {
    message.header = streams_.next(channel, t, t);
    const std::vector<std::uint8_t> data = encoded(message);
    const std::string name = channel;
    number(0xEDA1DA01, 4);
    number(count_++, 8);
    number(static_cast<std::uint64_t>(t), 8);
    number(name.size(), 4);
    number(data.size(), 4);
    bytes_ += name + std::string(data.begin(), data.end());
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void number(std::uint64_t value, int length) {
    for (int i = length - 1; i >= 0; --i) bytes_ += static_cast<char>(value >> (8 * i));
  }

  StreamCounter streams_{"fuzz", 1};
  std::uint64_t count_ = 0;
  std::string bytes_;
};

path_t short_path() {
  path_t path{};
  path.point_count = 2;
  path.x_m = {0.0, 3.0};
  path.y_m = {0.0, 0.5};
  path.level = {0, 0};
  path.direction = {0, 0};
  return path;
}

std::string short_log(Utime start) {
  LogBytes log;
  log.add(channel::kGlobalPath, short_path(), start);
  for (Utime t = start; t < start + 8 * kTickUs; t += kTickUs) {
    pose_t pose{};
    pose.quat_odom_body_wxyz[0] = pose.quat_map_odom_wxyz[0] = 1.0;
    log.add(channel::kPose, pose, t);
    truth_t truth{};
    truth.quat_map_body_wxyz[0] = 1.0;
    log.add(channel::kTruth, truth, t);
    log.add(channel::kState, supervisor_state_t{}, t);
    log.add(channel::kHeartbeat, heartbeat_t{}, t);
    tick_t tick{};
    tick.members = {"fuzz"};
    tick.member_count = 1;
    log.add(channel::kTick, tick, t);
  }
  return log.bytes();
}

void replay_all(const std::string& file) {
  replay::RecordedLog log(file);
  while (log.next()) {
  }
}

void spy_all(const std::string& file) {
  spy::Traffic traffic(spy::Traffic::Rates::kWhole);
  double last_s = 0.0;
  for_each_event(file, [&](const LogEvent& event) {
    last_s = std::max(last_s, to_seconds(event.time));
    traffic.add_message(event.channel, event.data, event.size, last_s);
  });
  traffic.statistics(last_s);
}

void run_log(const Input& input, Scratch& scratch) {
  const std::string file = scratch.write("traverse.lcm", input.bytes);
  fs::create_directories(scratch.out());
  read_or_refuse([&] { replay_all(file); });
  read_or_refuse([&] { spy_all(file); });
  read_or_refuse([&] { recorder::repair({file, scratch.out() + "/whole.lcm", false}); });
  read_or_refuse([&] { report::read_log(choose_run(file)); });
  interchange::ExportOptions options;
  options.log = file;
  options.out = scratch.out() + "/export";
  interchange::export_log(options);
}

}  // namespace

Parser logs_parser() {
  return {"logs",
          {{"traverse.lcm", short_log(1'000'000)}, {"two_runs.lcm", short_log(9'000'000) + short_log(1'000'000)}},
          {"TICK", "POSE", std::string("\xed\xa1\xda\x01", 4)},
          run_log};
}

}  // namespace rover::fuzz
