#include "test/bench_faults/judge/judge.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/core/frames.hpp"
#include "test/bench_faults/judge/precursors.hpp"
#include "test/bench_faults/log.hpp"

namespace rover::bench_faults {
namespace {

// Tolerance: the supervisor's thermal model differs slightly, and messages are processed one tick after publication.
constexpr Utime kToleranceUs = 2 * kTickUs;
constexpr Utime kDetectionUs = 1'000'000;
constexpr double kRestMps = 0.01;
constexpr double kCornerWheelM = 0.85;  // distance from the body origin

template <class Message>
Message decoded(const std::uint8_t* data, int size) {
  Message message{};
  decode_message(data, size, message);
  return message;
}

}  // namespace

Judge::Judge(const Settings& settings) : evidence_(settings), wheel_radius_m_(settings.wheel_radius_m) {
  for (const Row& row : settings.rows) rows_.push_back({row, Visibility(row), {}, kNever});
}

void Judge::take(const std::string& channel, const std::uint8_t* data, int size) {
  if (channel == kInjectionBegins) return begin(decoded<injection_t>(data, size));
  if (channel == kInjectionOver) return settle();
  if (channel == kKillOrdered) {
    const auto kill = decoded<injection_t>(data, size);
    return evidence_.kill_ordered(kill.target, kill.header.utime);
  }
  header_t header{};
  if (!peek_header(data, size, header)) return;
  if (channel == channel::kTick) return step(header.utime);
  if (channel == channel::kInject) return deliveries_.inject(decoded<injection_t>(data, size));
  if (channel == channel::kDrivePermit) return add_permit(decoded<drive_permit_t>(data, size));
  if (channel == channel::kFault) return add_fault(decoded<fault_t>(data, size));
  if (channel == channel::kTruth) return add_truth(decoded<truth_t>(data, size));
  if (channel == channel::kCommandAck) return add_ack(decoded<command_ack_t>(data, size));
  if (channel == channel::kGroundCommand) add_command(decoded<ground_command_t>(data, size));
  if (channel == channel::kState) evidence_.state(decoded<supervisor_state_t>(data, size));
  if (channel == channel::kWheelState) {
    wheel_mps_ = 0.0;
    for (const double rate : decoded<wheel_state_t>(data, size).drive_rate_radps)
      wheel_mps_ = std::max(wheel_mps_, std::abs(rate) * wheel_radius_m_);
  }
  deliveries_.sent({channel, header, {data, data + size}});
}

Judge::Watched* Judge::find(const std::string& id) {
  const auto it = std::find_if(rows_.begin(), rows_.end(), [&](const Watched& w) { return w.row.id == id; });
  return it == rows_.end() ? nullptr : &*it;
}

void Judge::step(Utime tick) {
  if (first_tick_ == kNever) first_tick_ = tick;
  last_tick_ = tick;
  for (const Delivery& delivery : deliveries_.take(tick)) evidence_.take(delivery);
  evidence_.tick(tick);
  for (Watched& watched : rows_) {
    watched.now = watched.visibility.step(tick, evidence_.armed(watched.row), evidence_.measure(watched.row));
    if (watched.now.utime != kNever) watched.last_tick = tick;
  }
  look_at_active(tick);
  measure_rest(tick);
  for (Raised& raised : unproven_) {
    const Watched* watched = find(raised.row);
    raised.excused =
        watched != nullptr && watched->last_tick != kNever && watched->last_tick >= raised.utime - kToleranceUs;
    if (!raised.excused && tick > raised.utime + kToleranceUs) false_alarms_.push_back({raised.utime, raised.row});
  }
  std::erase_if(unproven_, [&](const Raised& r) { return r.excused || tick > r.utime + kToleranceUs; });
}

void Judge::begin(const injection_t& injection) {
  Verdict verdict;
  verdict.injection_id = injection.injection_id;
  verdict.row = injection.target;
  verdict.phase = injection.header.publisher;
  verdict.cause = injection.fault;
  verdict.begun = injection.header.utime;
  const Watched* watched = find(injection.target);
  verdict.line = watched == nullptr ? injection.target : watched->row.line;
  verdict.stops = watched != nullptr && watched->row.stops;
  active_ = verdict;
  stopping_since_ = kNever;
}

void Judge::look_at_active(Utime tick) {
  if (!active_ || active_->visible != kNever) return;
  const Watched* watched = find(active_->row);
  if (watched == nullptr || watched->last_tick != tick) return;
  active_->visible = watched->now.utime;
  active_->visible_release = watched->now.release;
  granted_when_visible_ = granted_ || (withdrawn_at_ != kNever && tick - withdrawn_at_ <= kToleranceUs);
  if (!granted_ && granted_when_visible_) note_withdrawal(withdrawn_at_);
}

void Judge::add_command(const ground_command_t& command) {
  if (command.kind == ground_command_t::CLEAR_FAULT) clear_commands_.insert(command.command_id);
  if (command.kind == ground_command_t::FORCE_LEVEL) level_commands_[command.command_id] = command.level;
}

// An accepted CLEAR_FAULT resets all counters.
void Judge::add_ack(const command_ack_t& ack) {
  if (clear_commands_.erase(ack.command_id) > 0 && ack.accepted) evidence_.forget_counts();
  const auto level = level_commands_.extract(ack.command_id);
  if (!level.empty() && ack.accepted) evidence_.force_level(level.mapped());
}

void Judge::add_permit(const drive_permit_t& permit) {
  evidence_.permit(permit);
  const bool withdrawn = granted_ && !permit.granted;
  granted_ = permit.granted != 0;
  if (!withdrawn) return;
  withdrawn_at_ = permit.header.utime;
  if (active_ && active_->visible != kNever && granted_when_visible_) note_withdrawal(withdrawn_at_);
}

// Counts from the release of the permit.
void Judge::note_withdrawal(Utime at) {
  if (!active_->stops || active_->withdrawn_s) return;
  const Utime release = at + kTickUs;
  active_->withdrawn_s = to_seconds(release - active_->visible);
  active_->withdrawn_since_known_s = to_seconds(release - active_->visible_release);
  active_->speed_mps = wheel_mps_;
  stopping_since_ = release;
}

void Judge::add_fault(const fault_t& fault) {
  const bool was_active = fault_active_[fault.id];
  fault_active_[fault.id] = fault.active != 0;
  if (!fault.active || was_active) return;
  unproven_.push_back({fault.header.utime, fault.id});
  if (!active_) return;
  if (active_->first_raised.empty()) active_->first_raised = fault.id;
  if (fault.id == active_->row && active_->raised == kNever) active_->raised = fault.header.utime;
}

void Judge::add_truth(const truth_t& truth) {
  const double* v = truth.velocity_map_mps;
  body_mps_ = std::hypot(v[0], v[1], v[2]);
  const double* q = truth.quat_map_body_wxyz;
  const double yaw = std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  turn_mps_ = std::abs(wrap_angle(yaw - yaw_rad_)) / to_seconds(kTickUs) * kCornerWheelM;
  yaw_rad_ = yaw;
}

void Judge::measure_rest(Utime tick) {
  if (!active_ || stopping_since_ == kNever || active_->still_s || tick < stopping_since_) return;
  if (std::max({body_mps_, turn_mps_, wheel_mps_}) > kRestMps) return;
  active_->still_s = to_seconds(tick - stopping_since_);
}

void Judge::settle() {
  if (!active_) return;
  Verdict& v = *active_;
  v.detected = v.visible != kNever && v.raised != kNever && v.raised >= v.visible - kToleranceUs &&
               v.raised <= v.visible_release + kDetectionUs;
  v.named = v.raised != kNever && (v.first_raised == v.row || precursors(v.row).contains(v.first_raised));
  verdicts_.push_back(v);
  active_.reset();
}

void Judge::finish() {
  settle();
}

}  // namespace rover::bench_faults
