#include "tools/report/log_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <rover/command_ack_t.hpp>
#include <rover/elevation_t.hpp>
#include <tuple>
#include <utility>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/streams.hpp"
#include "tools/report/convert.hpp"

namespace rover::report {
namespace {

constexpr double kUncountedS = 1.1;       // longer than any message is under way
constexpr double kElevationEveryM = 1.0;  // driven distance between stored maps; each map covers 20 m

// Counts published messages by sequence number: a reduced log omits images, and a TICK repeated for a late node is no
// new message.
class BusCounter {
 public:
  explicit BusCounter(Utime end) : end_(end) {}

  void add(const LogEvent& event, const header_t& header) {
    if (header.utime > end_) return;
    Stream& stream = streams_[{event.channel, header.publisher, header.boot_id}];
    ++stream.recorded;
    stream.bytes += event.size;
    stream.last_seq = std::max(stream.last_seq, header.seq);
  }
  void total(BusRecord& bus) const {
    for (const auto& [key, stream] : streams_) {
      const std::int64_t published = stream.last_seq > 0 ? stream.last_seq : stream.recorded;
      bus.messages += published;
      bus.bytes += stream.bytes / stream.recorded * published + stream.bytes % stream.recorded;
    }
  }

 private:
  struct Stream {
    std::int64_t recorded = 0;
    std::int64_t bytes = 0;
    std::int64_t last_seq = 0;
  };
  std::map<std::tuple<std::string, std::string, std::int64_t>, Stream> streams_;
  Utime end_;
};

class Reader {
 public:
  explicit Reader(Utime counted_until) : counter_(counted_until) {
    take<truth_t>(channel::kTruth, [this](const truth_t& m) { run_.truth.push_back(truth_from(m)); });
    take<pose_t>(channel::kPose, [this](const pose_t& m) { add_pose(m); });
    take<control_status_t>(channel::kControlStatus,
                           [this](const control_status_t& m) { run_.control.push_back(control_from(m)); });
    take<wheel_state_t>(channel::kWheelState,
                        [this](const wheel_state_t& m) { run_.wheels.push_back(wheels_from(m)); });
    take<slip_t>(channel::kSlip, [this](const slip_t& m) { run_.slip.push_back(slip_from(m)); });
    take<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& m) { add_state(m); });
    take<path_t>(channel::kGlobalPath, [this](const path_t& m) { run_.global_paths.push_back(path_from(m)); });
    take<command_ack_t>(channel::kCommandAck, [this](const command_ack_t& m) {
      if (m.header.publisher == "path_planner") accepted_paths_[m.command_id] |= m.accepted != 0;
    });
    take<path_t>(channel::kPath, [this](const path_t& m) { add_path(path_from(m)); });
    take<hazards_t>(channel::kHazards, [this](const hazards_t& m) {
      run_.hazards.push_back(hazards_from(m));
      add_map(passability_from(m), run_.hazard_maps);
    });
    take<traversability_t>(channel::kTraversability, [this](const traversability_t& m) {
      add_map(passability_from(m), run_.traversability_maps);
    });
    take<drive_permit_t>(channel::kDrivePermit, [this](const drive_permit_t& m) {
      if (m.granted) run_.permits.push_back({to_seconds(m.header.release_utime), to_seconds(m.valid_until_utime)});
    });
    take<planner_status_t>(channel::kPlannerStatus,
                           [this](const planner_status_t& m) { run_.planner.push_back(planner_from(m)); });
    take<fault_t>(channel::kFault, [this](const fault_t& m) { add_fault(fault_from(m)); });
    take<correction_t>(channel::kCorrection,
                       [this](const correction_t& m) { run_.corrections.push_back(correction_from(m)); });
    take<heartbeat_t>(channel::kHeartbeat, [this](const heartbeat_t& m) { add_heartbeat(m, run_.services); });
    take<slam_pose_t>(channel::kSlamPose, [this](const slam_pose_t& m) { add_slam(slam_from(m)); });
    take<elevation_t>(channel::kElevation, [this](const elevation_t& m) { add_elevation(m); });
    take<vo_motion_t>(channel::kVo, [this](const vo_motion_t& m) { run_.visual.push_back(visual_from(m)); });
  }

  void add(const LogEvent& event) {
    header_t header{};
    if (!peek_header(event.data, event.size, header)) {
      ++run_.bus.damaged_events;
      return;
    }
    counter_.add(event, header);
    if (event.channel == channel::kTick) {
      if (last_tick_ != kNever && header.utime > last_tick_ + kLongestTickGap)
        run_.bus.missing_s += to_seconds(header.utime - last_tick_);
      last_tick_ = header.utime;
    }
    const auto handler = handlers_.find(event.channel);
    if (handler == handlers_.end()) return;
    const bool whole = find_channel_type(event.channel)->decodes(event.data, event.size);
    if (!whole || !handler->second(event)) ++run_.bus.damaged_events;
  }

  void count_damaged() { ++run_.bus.damaged_events; }

  void expect_ticks_until(Utime end) {
    if (end <= last_tick_ + kLongestTickGap) return;
    run_.bus.missing_end_s = to_seconds(end - last_tick_);
    run_.bus.missing_s += run_.bus.missing_end_s;
  }

  RunRecord finish() {
    counter_.total(run_.bus);
    // A log without answers, as of another planner, tells nothing about refusals.
    if (!accepted_paths_.empty())
      std::erase_if(run_.global_paths, [this](const PathRecord& path) { return !accepted_paths_[path.id]; });
    return std::move(run_);
  }

 private:
  template <class Message>
  void take(const std::string& channel, std::function<void(const Message&)> handler) {
    handlers_[channel] = [handler = std::move(handler)](const LogEvent& event) {
      Message message;
      if (!decode_message(event.data, event.size, message)) return false;
      handler(message);
      return true;
    };
  }
  // Active faults are repeated; reports of one row differ in the time at which the fault became visible.
  void add_fault(const FaultRecord& fault) {
    const bool known = std::any_of(run_.faults.begin(), run_.faults.end(), [&](const FaultRecord& before) {
      return before.id == fault.id && before.t_s == fault.t_s && before.active == fault.active;
    });
    if (!known) run_.faults.push_back(fault);
  }
  void add_pose(const pose_t& message) {
    if (message.status == pose_t::UNINITIALISED || message.status == pose_t::LOST) return;
    const PoseSample sample = pose_from(message);
    if (is_finite(sample.T_odom_body) && is_finite(sample.T_map_odom)) run_.poses.push_back(sample);
  }
  static void add_map(std::optional<PassabilityMap> map, std::vector<PassabilityMap>& maps) {
    if (map) maps.push_back(std::move(*map));
  }
  void add_slam(const SlamSample& sample) {
    const Pose2& p = sample.T_slam_odom;
    if (std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.yaw_rad)) run_.slam.push_back(sample);
  }
  void add_elevation(const elevation_t& message) {
    if (run_.poses.empty()) return;
    const Eigen::Vector3d at = run_.poses.back().T_odom_body.translation();
    if ((at - elevation_at_).head<2>().norm() < kElevationEveryM) return;
    elevation_at_ = at;
    run_.elevation.add(message.cell_m, message.origin_x_m, message.origin_y_m, message.cells_x, message.height_m);
  }
  // A path is repeated each second.
  void add_path(PathRecord path) {
    if (run_.local_paths.empty() || run_.local_paths.back().id != path.id) run_.local_paths.push_back(std::move(path));
  }
  void add_state(const supervisor_state_t& message) {
    const StateChange change = state_from(message);
    if (run_.states.empty() || run_.states.back().state != change.state || run_.states.back().full != change.full)
      run_.states.push_back(change);
    if (std::exchange(full_services_run_, message.full_stopped == 0) || !full_services_run_) return;
    for (auto& [name, service] : run_.services) service.starts_on_demand += is_full_service(name) ? 1 : 0;
  }

  RunRecord run_;
  static constexpr Utime kLongestTickGap = 1'000'000;
  Utime last_tick_ = kNever;
  std::map<std::int64_t, bool> accepted_paths_;  // by id, of all answers
  bool full_services_run_ = true;
  Eigen::Vector3d elevation_at_ = Eigen::Vector3d::Constant(kInfinity);  // odom, at the newest stored map
  BusCounter counter_;
  std::map<std::string, std::function<bool(const LogEvent&)>> handlers_;
};

}  // namespace

RunRecord read_log(const LogRun& run, std::optional<double> run_s) {
  // Of a log of several runs it is not known which one took run_s.
  const bool timed = run_s && run.of == 1 && run.first_tick != kNever;
  Reader reader(timed ? run.first_tick + to_utime(*run_s - kUncountedS) : std::numeric_limits<Utime>::max());
  for_each_event(run, [&](const LogEvent& event) { reader.add(event); });
  if (run.skipped_bytes > 0) reader.count_damaged();
  if (timed) reader.expect_ticks_until(run.first_tick + to_utime(*run_s));
  return reader.finish();
}

}  // namespace rover::report
