#include "supervisor/supervisor.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

using enum State;

// Staleness counts wherever all inputs have once been there.
constexpr StateSet kArmedAlways = {kStandby, kDriving,     kHazardStop, kRepairing, kSweeping, kCorrecting,
                                   kPaused,  kGoalReached, kFaultStop,  kSafe,      kTeleop};
constexpr StateSet kArmedUnderWay = {kDriving, kHazardStop, kRepairing, kFaultStop};

std::optional<Fact> fact_of(CommandKind kind) {
  switch (kind) {
    case CommandKind::kGo:
      return Fact::kCommandGo;
    case CommandKind::kStop:
      return Fact::kCommandStop;
    case CommandKind::kPause:
      return Fact::kCommandPause;
    case CommandKind::kResume:
      return Fact::kCommandResume;
    case CommandKind::kEmergencyStop:
      return Fact::kCommandEmergencyStop;
    case CommandKind::kClearSafe:
      return Fact::kCommandClearSafe;
    default:
      return std::nullopt;
  }
}

}  // namespace

Supervisor::Supervisor(const SupervisorConfig& config) : config_(config) {
  add_streams();
  add_path_rows();
}

void Supervisor::add(const char* id, const char* quantity, double limit, double persistence_s, Read read) {
  MonitorRow row;
  row.id = id;
  row.quantity = quantity;
  row.limit = limit;
  row.persistence_s = persistence_s;
  row.clear_s = config_.clear_confirm_s;
  row.armed = kArmedAlways;
  watches_.push_back({Monitor(row), read, ""});
}

void Supervisor::add_streams() {
  add("pose_age", "pose_age_s", config_.pose_max_age_s, 0.0, &Supervisor::read_pose_age);
  add("pose_status", "pose_lost", 0.0, 0.0, &Supervisor::read_pose_status);
  add("hazards_age", "hazards_age_s", config_.hazards_max_age_s, 0.0, &Supervisor::read_hazards_age);
  add("hazards_blind", "blind_frames", config_.blind_frames - 1, 0.0, &Supervisor::read_hazards_blind);
  add("planner_age", "planner_status_age_s", config_.planner_max_age_s, 0.0, &Supervisor::read_planner_age);
  add("control_age", "control_status_age_s", config_.control_max_age_s, 0.0, &Supervisor::read_control_age);
  for (const std::string& service : config_.required_services) {
    add(("heartbeat." + service).c_str(), "heartbeat_age_s", config_.heartbeat_max_age_s, 0.0,
        &Supervisor::read_heartbeat);
    watches_.back().service = service;
  }
}

void Supervisor::add_path_rows() {
  const auto under_way = [this](bool latched, Response response) {
    MonitorRow row = watches_.back().monitor.row();
    row.armed = kArmedUnderWay;
    row.latched = latched;
    row.response = response;
    watches_.back().monitor = Monitor(row);
  };
  add("out_of_corridor", "cross_track_m", 0.0, 0.0, &Supervisor::read_corridor);
  under_way(false, Response::kStop);
  add("path_mismatch", "path_id_followed", 0.0, config_.path_mismatch_s, &Supervisor::read_path_mismatch);
  under_way(false, Response::kStop);
  add("no_path", "planner_no_path", 0.0, config_.no_path_s, &Supervisor::read_no_path);
  under_way(true, Response::kStop);
  add("blocked", "blocked_in_m", 0.0, config_.blocked_s, &Supervisor::read_blocked);
  under_way(true, Response::kStop);
  add("slip", "slip_ratio", config_.slip_limit, config_.slip_persistence_s, &Supervisor::read_slip);
  under_way(false, Response::kLog);
}

Reading Supervisor::read_pose_age(const Watch& watch, Utime now) const {
  return age_reading(pose_.utime, now, watch.monitor.row().limit);
}

Reading Supervisor::read_pose_status(const Watch&, Utime now) const {
  return flag_reading(!pose_.usable, pose_.utime, now);
}

Reading Supervisor::read_hazards_age(const Watch& watch, Utime now) const {
  return age_reading(hazards_.utime, now, watch.monitor.row().limit);
}

Reading Supervisor::read_hazards_blind(const Watch& watch, Utime now) const {
  return above_reading(blind_in_a_row_, watch.monitor.row().limit, hazards_.utime, now);
}

Reading Supervisor::read_planner_age(const Watch& watch, Utime now) const {
  return age_reading(planner_.utime, now, watch.monitor.row().limit);
}

Reading Supervisor::read_control_age(const Watch& watch, Utime now) const {
  return age_reading(control_.utime, now, watch.monitor.row().limit);
}

Reading Supervisor::read_heartbeat(const Watch& watch, Utime now) const {
  const auto beat = heartbeats_.find(watch.service);
  return age_reading(beat == heartbeats_.end() ? kNever : beat->second, now, watch.monitor.row().limit);
}

Reading Supervisor::read_corridor(const Watch&, Utime now) const {
  Reading out = flag_reading(control_.out_of_corridor, control_.utime, now);
  out.value = control_.cross_track_m;
  out.limit = control_.corridor_half_width_m;
  return out;
}

Reading Supervisor::read_path_mismatch(const Watch&, Utime now) const {
  Reading out = flag_reading(control_.path_id != planner_.path_id, control_.utime, now);
  out.value = static_cast<double>(control_.path_id);
  out.limit = static_cast<double>(planner_.path_id);
  return out;
}

Reading Supervisor::read_no_path(const Watch&, Utime now) const {
  return flag_reading(planner_.state == PlannerState::kNoPath && standing_still(), planner_.utime, now);
}

Reading Supervisor::read_blocked(const Watch&, Utime now) const {
  const bool waiting = state_ == kHazardStop || state_ == kRepairing;
  Reading out = flag_reading(waiting && blocked_in_m() <= stop_distance_m(), planner_.utime, now);
  out.value = planner_.blocked_in_m;
  out.limit = stop_distance_m();
  return out;
}

Reading Supervisor::read_slip(const Watch& watch, Utime now) const {
  // At rest slip is not defined, and says so itself; that is not a fault.
  if (!slip_.valid) return flag_reading(false, slip_.utime, now);
  return above_reading(slip_.ratio, watch.monitor.row().limit, slip_.utime, now);
}

void Supervisor::on_heartbeat(const std::string& service, Utime utime) {
  Utime& newest = heartbeats_.try_emplace(service, kNever).first->second;
  newest = std::max(newest, utime);
}

void Supervisor::on_hazards(const HazardsReport& hazards) {
  hazards_ = hazards;
  blind_in_a_row_ = hazards.blind ? blind_in_a_row_ + 1 : 0;
}

SupervisorOutput Supervisor::step(Utime now) {
  if (since_ == kNever) since_ = now;
  SupervisorOutput out;
  run_monitors(now, out);
  FactSet current = facts(now);
  for (const GroundCommand& command : commands_) out.answers.push_back(answer(command, current, now, out));
  commands_.clear();
  // The table has no cycle under unchanging facts (tested), so this ends.
  while (const Transition* row = next_transition(state_, current)) fire(*row, now, out);
  out.permit = permit(current, now);
  return out;
}

void Supervisor::run_monitors(Utime now, SupervisorOutput& out) {
  for (Watch& watch : watches_)
    if (watch.monitor.step(now, state_, (this->*watch.read)(watch, now))) record(watch, out);
}

void Supervisor::record(const Watch& watch, SupervisorOutput& out) {
  const Monitor& m = watch.monitor;
  if (m.standing()) {
    standing_.push_back(m.row().id);
  } else {
    std::erase(standing_, m.row().id);
  }
  const bool first = !standing_.empty() && standing_.front() == m.row().id;
  out.faults.push_back({m.row().id, m.reading().condition, m.row().response, m.reading().value, m.limit(),
                        m.visible_utime(), m.standing(), first});
}

FactSet Supervisor::facts(Utime now) {
  FactSet out;
  const double pose_age = age_reading(pose_.utime, now, kInfinity).data_age_s;
  const double planner_age = age_reading(planner_.utime, now, kInfinity).data_age_s;
  const double control_age = age_reading(control_.utime, now, kInfinity).data_age_s;
  set_fact(out, Fact::kInputsReady, inputs_ready(now), {"services_required", double(config_.required_services.size())});
  set_fact(out, Fact::kPoseFresh, pose_.usable && pose_age <= config_.pose_max_age_s,
           {"pose_age_s", pose_age, config_.pose_max_age_s, 0.0, pose_age});
  set_fact(out, Fact::kStanding, standing_still(),
           {"speed_mps", pose_.speed_mps, config_.standing_speed_mps, 0.0, pose_age});
  set_fact(out, Fact::kPlannerRepairing, planner_.state == PlannerState::kRepairing,
           {"planner_state", double(planner_.state), double(PlannerState::kRepairing), 0.0, planner_age});
  set_fact(
      out, Fact::kGoalReached, control_.path_end && planner_.goal_distance_m <= config_.goal_tolerance_m,
      {"goal_distance_m", planner_.goal_distance_m, config_.goal_tolerance_m, 0.0, std::max(planner_age, control_age)});
  path_facts(out, planner_age);
  fault_fact(out);
  return out;
}

void Supervisor::set_fact(FactSet& facts, Fact fact, bool on, const Evidence& evidence) {
  facts.set(fact, on);
  evidence_[static_cast<size_t>(fact)] = evidence;
}

void Supervisor::path_facts(FactSet& facts, double planner_age_s) {
  const bool present = planner_.path_id >= 0;
  const double way = blocked_in_m();
  const double stop = stop_distance_m();
  // The hysteresis keeps measuring noise from starting and stopping the rover; a new path is judged by itself.
  const double clear = planner_.path_id == blocked_path_id_ ? stop + config_.stop_hysteresis_m : stop;
  set_fact(facts, Fact::kPathPresent, present, {"path_id", double(planner_.path_id), 0.0, 0.0, planner_age_s});
  set_fact(facts, Fact::kPathBlocked, !present || !(way > stop), {"blocked_in_m", way, stop, 0.0, planner_age_s});
  set_fact(facts, Fact::kPathClear, present && way > clear, {"blocked_in_m", way, clear, 0.0, planner_age_s});
}

void Supervisor::fault_fact(FactSet& facts) {
  blocking_fault_.clear();
  for (const std::string& id : standing_) {
    const auto watch = std::find_if(watches_.begin(), watches_.end(),
                                    [&](const Watch& w) { return w.monitor.row().id == id && w.monitor.blocks(); });
    if (watch == watches_.end()) continue;
    const Monitor& m = watch->monitor;
    blocking_fault_ = id;
    evidence_[static_cast<size_t>(Fact::kBlockingFault)] = {m.row().quantity, m.reading().value, m.limit(),
                                                            m.row().persistence_s, m.reading().data_age_s};
    break;
  }
  facts.set(Fact::kBlockingFault, !blocking_fault_.empty());
}

bool Supervisor::inputs_ready(Utime now) const {
  const auto fresh = [now](Utime utime, double limit_s) {
    return age_reading(utime, now, limit_s).condition == Condition::kFalse;
  };
  return services_alive(now) && pose_.usable && fresh(pose_.utime, config_.pose_max_age_s) &&
         fresh(hazards_.utime, config_.hazards_max_age_s) && fresh(planner_.utime, config_.planner_max_age_s) &&
         fresh(control_.utime, config_.control_max_age_s);
}

bool Supervisor::services_alive(Utime now) const {
  return std::all_of(watches_.begin(), watches_.end(), [&](const Watch& w) {
    return w.service.empty() || read_heartbeat(w, now).condition == Condition::kFalse;
  });
}

bool Supervisor::standing_still() const {
  return pose_.speed_mps < config_.standing_speed_mps && std::abs(pose_.turn_rate_radps) < config_.standing_rate_radps;
}

double Supervisor::stop_distance_m() const {
  return planner_.block_kind == BlockKind::kUnseen ? config_.unseen_stop_m : config_.hazard_stop_m;
}

// Without a number: at once.
double Supervisor::blocked_in_m() const {
  return planner_.path_id < 0 || std::isnan(planner_.blocked_in_m) ? 0.0 : planner_.blocked_in_m;
}

CommandAnswer Supervisor::answer(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out) {
  if (command.kind == CommandKind::kClearFault) return clear_fault(command, facts, out);
  const std::optional<Fact> fact = fact_of(command.kind);
  if (!fact) return {command.id, false, "command not known to this supervisor"};
  FactSet with_command = facts;
  with_command.insert(*fact);
  const Transition* row = next_transition(state_, with_command);
  if (row == nullptr || !row->needs.has(*fact)) return {command.id, false, refusal(state_, facts, *fact)};
  fire(*row, now, out);
  return {command.id, true, ""};
}

CommandAnswer Supervisor::clear_fault(const GroundCommand& command, FactSet& facts, SupervisorOutput& out) {
  for (Watch& watch : watches_) {
    if (watch.monitor.row().id != command.target || !watch.monitor.standing()) continue;
    if (!watch.monitor.unlatch()) return {command.id, false, "the condition still holds"};
    record(watch, out);
    fault_fact(facts);
    return {command.id, true, ""};
  }
  return {command.id, false, "no such fault stands"};
}

void Supervisor::fire(const Transition& row, Utime now, SupervisorOutput& out) {
  StateChange change{state_, row.to, row.cause, evidence_[static_cast<size_t>(row.evidence)]};
  if (row.to == kFaultStop) change.cause = blocking_fault_;
  if (state_ == kDriving && row.to == kHazardStop) ++hazard_stops_;
  if (row.to == kHazardStop) blocked_path_id_ = planner_.path_id;
  state_ = row.to;
  since_ = now;
  last_change_ = change;
  out.changes.push_back(change);
}

Permit Supervisor::permit(FactSet facts, Utime now) const {
  if (permit_allowed(state_, facts))
    return {true, config_.max_speed_mps, now + to_utime(config_.permit_validity_s), ""};
  return {false, 0.0, now, state_ == kDriving ? "guard" : name(state_)};
}

}  // namespace rover::supervisor
