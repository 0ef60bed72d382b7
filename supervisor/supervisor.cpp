#include "supervisor/supervisor.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

using enum State;

constexpr StateSet kDriveInProgress = {kDriving, kHazardStop, kRepairing};
constexpr double kMinApproachMps = 0.05;  // towards the place where the rover stops
constexpr double kReactionS = 0.2;        // from a pose to the wheels, as response_delay_s of trajectory_control
constexpr double kMaxSavedAgeS = 10.0;    // of a checkpoint: saved each second, and back 5 s after a hang

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

bool fresh(Utime utime, Utime now, double limit_s) {
  return age_reading(utime, now, limit_s).condition == Condition::kFalse;
}

double age_s(Utime utime, Utime now) {
  return age_reading(utime, now, kInfinity).data_age_s;
}

Evidence evidence_of(const Monitor& m) {
  return {m.row().quantity, m.reading().value, m.limit(), m.row().persistence_s, m.reading().data_age_s};
}

}  // namespace

Supervisor::Supervisor(const SupervisorConfig& config)
    : config_(config),
      derived_(config.derived),
      fdir_(config.fdir),
      restarter_(config.restarts),
      level_selector_(config.level),
      on_demand_(config.level.linger_s) {}

void Supervisor::on_service(const std::string& name, const ServiceReport& report) {
  if (on_demand_.state() == OnDemand::State::kStopped && on_demand(name)) return;
  ServiceReport& newest = inputs_.services[name];
  if (report.utime < newest.utime || report.boot_id < newest.boot_id) return;
  derived_.on_service(name, newest, report);
  newest = report;
}

void Supervisor::on_hazards(const HazardsReport& hazards) {
  if (inputs_.hazards.utime != kNever) frame_interval_s_ = to_seconds(hazards.utime - inputs_.hazards.utime);
  inputs_.hazards = hazards;
  inputs_.consecutive_blind_frames = hazards.blind ? inputs_.consecutive_blind_frames + 1 : 0;
  if (!hazards.blind) inputs_.seen_utime = hazards.utime;
}

// Backing up for want of a path does not relax limits: only paths that follow a stop_backtrack fault do.
void Supervisor::on_path(PathLevels path) {
  if (path.path_id != path_.path_id) {
    // Repeated after a restart, or changed on its way; another one begins at rest.
    const bool goes_on = path.path_id == backtracking_path_id_ || (backtracking_path_id_ >= 0 && !stationary());
    const bool backtracking = path.backtrack && (goes_on || fdir_.backtrack_requested());
    backtracking_path_id_ = backtracking ? path.path_id : -1;
  }
  path_ = std::move(path);
}

void Supervisor::on_wheels(const WheelReport& wheels) {
  inputs_.wheels = wheels;
  derived_.on_wheels(wheels);
}

void Supervisor::on_terrain(const TerrainReport& terrain) {
  inputs_.terrain = terrain;
  inputs_.terrain.travelled_m = inputs_.pose.travelled_m;
}

SupervisorOutput Supervisor::step(Utime now) {
  SupervisorOutput out;
  if (since_ == kNever) begin(now, out);
  derived_.step(now, inputs_, permitted_);
  run_monitors(now, out);
  run_level(now, out);
  FactSet current = facts(now);
  for (const GroundCommand& command : commands_) out.answers.push_back(answer(command, current, now, out));
  commands_.clear();
  // Terminates: the table has no cycle for constant facts (tested).
  while (const Transition* row = next_transition(state_, current)) fire(*row, now, out);
  out.permit = permit(current, now);
  permitted_ = out.permit.granted;
  return out;
}

// Heartbeat ages count from the start, because nothing was received before.
void Supervisor::begin(Utime now, SupervisorOutput& out) {
  since_ = now;
  if (restored_ && state_ != kSafe) check_restored(now, out);
  const auto count_from_now = [&](const std::vector<std::string>& services) {
    for (const std::string& service : services)
      if (ServiceReport& report = inputs_.services[service]; report.utime == kNever) report.utime = now;
  };
  if (state_ != kBoot) count_from_now(config_.fdir.required_services);
  if (level_ == Level::kFull) count_from_now(config_.fdir.full_services);
}

// What happened after an old state was saved is not known; the operator may have ordered EMERGENCY_STOP.
void Supervisor::check_restored(Utime now, SupervisorOutput& out) {
  const bool usable = restored_utime_ != kNever;
  const double saved_s_ago = to_seconds(now - restored_utime_);
  if (usable && std::abs(saved_s_ago) <= kMaxSavedAgeS) return;
  last_change_ = {state_, kSafe, level_, level_, usable ? "checkpoint_old" : "checkpoint_unusable", {}};
  if (usable) last_change_.evidence = {"checkpoint_age_s", saved_s_ago, kMaxSavedAgeS, 0.0, saved_s_ago};
  state_ = kSafe;
  out.changes.push_back(last_change_);
}

MonitorContext Supervisor::monitor_context(Utime now) const {
  const bool waiting = state_ == kHazardStop || state_ == kRepairing;
  const bool backtracking =
      backtracking_path_id_ >= 0 && backtracking_path_id_ == inputs_.planner.path_id && state_ != kTeleop;
  return {inputs_,           derived_.values(), now,
          stationary(),      waiting,           config_.stop_distance_m,
          sweep_s(now),      backtracking,      full_missing_s(now),
          keep_out_depth_m()};
}

// Of the footprint now, and on the circle that the rover is on until it has reacted and braked. On the spot its ends
// brake as the wheels do.
double Supervisor::keep_out_depth_m() const {
  const PoseReport& pose = inputs_.pose;
  if (restored_ && path_.path_id < 0 && inputs_.planner.path_id >= 0) return kNaN;  // its zones come within a second
  if (path_.zones.empty() || !pose.usable) return 0.0;
  const double v = pose.forward_mps, rate = pose.turn_rate_radps;
  const bool drives = std::abs(v) > config_.stationary_speed_mps;
  const double turn_deceleration = config_.deceleration_mps2 / config_.footprint_half_length_m;
  const double stop_m = v * kReactionS + 0.5 * v * std::abs(v) / config_.deceleration_mps2;
  const double turn_rad =
      drives ? stop_m * rate / v : rate * kReactionS + 0.5 * rate * std::abs(rate) / turn_deceleration;
  if (!std::isfinite(stop_m + turn_rad)) return kNaN;
  double depth_m = 0.0;
  for (const double u : {0.0, 0.5, 1.0}) {
    const double course_rad = pose.odom.yaw_rad + 0.5 * u * turn_rad;
    const Pose2 at{pose.odom.x_m + u * stop_m * std::cos(course_rad), pose.odom.y_m + u * stop_m * std::sin(course_rad),
                   pose.odom.yaw_rad + u * turn_rad};
    depth_m = std::max(
        depth_m, forbidden_depth_m(path_.zones, at, config_.footprint_half_length_m, config_.footprint_half_width_m));
  }
  return depth_m;
}

void Supervisor::run_monitors(Utime now, SupervisorOutput& out) {
  derived_.set_restart_attempts(restarter_.restart_attempts(now));
  out.faults = fdir_.step(monitor_context(now), state_, level_);
  out.restarts = restarter_.step(now, fdir_.services_to_restart());
}

void Supervisor::run_level(Utime now, SupervisorOutput& out) {
  level_selector_.step(now, inputs_, hazard_stops_, kDriveInProgress.has(state_));
  LevelFactSet facts = level_facts(now);
  run_full_services(now, facts, out);
  if (const LevelTransition* row = next_level(level_, facts)) fire(*row, out);
}

// They are wanted before a drive, at the Full level, and if being ready would raise the level. Only if all
// are ready are they stopped: otherwise one is missing or has failed.
void Supervisor::run_full_services(Utime now, LevelFactSet& facts, SupervisorOutput& out) {
  LevelFactSet if_ready = facts;
  if_ready.insert(LevelFact::kFullReady);
  const LevelTransition* row = next_level(level_, if_ready);
  const bool before_drive = state_ == kBoot || state_ == kStandby;
  const bool full = row == nullptr ? level_ == Level::kFull : row->to == Level::kFull;
  const bool not_ready = full_services_wanted() && !facts.has(LevelFact::kFullReady);
  full_missing(row, facts.has(LevelFact::kFullReady), now);
  const bool changed = on_demand_.step(now, before_drive || full || not_ready);
  if (!full_services_wanted()) facts.erase(LevelFact::kFullReady);
  if (!changed || on_demand_.state() == OnDemand::State::kLeaving) return;
  out.run_full = full_services_wanted();
  if (!*out.run_full) std::erase_if(inputs_.services, [this](const auto& service) { return on_demand(service.first); });
}

void Supervisor::full_missing(const LevelTransition* rise_if_ready, bool ready, Utime now) {
  using enum LevelFact;
  const bool required = level_ == Level::kEfficient && rise_if_ready != nullptr &&
                        (rise_if_ready->evidence == kPathFull || rise_if_ready->evidence == kForcedFull);
  if (!required || ready) full_missing_ = kNever;
  if (required && !ready && full_missing_ == kNever) full_missing_ = now;
}

bool Supervisor::on_demand(const std::string& service) const {
  const std::vector<std::string>& all = config_.on_demand_services;
  return std::find(all.begin(), all.end(), service) != all.end();
}

LevelFactSet Supervisor::level_facts(Utime now) {
  using F = LevelFact;
  LevelFactSet out;
  const double planner_age = age_s(inputs_.planner.utime, now);
  const bool followed = path_.path_id >= 0 && path_.path_id == inputs_.control.path_id;
  // PATH and CONTROL_STATUS of a new path arrive at different ticks, and without a pose there is no place on it: the
  // old value is kept.
  if (followed && std::isfinite(inputs_.control.arc_length_m))
    path_full_ = path_.at(inputs_.control.arc_length_m) == Level::kFull;
  const LevelConfig& limits = level_selector_.config();
  const std::vector<std::string>& full = config_.fdir.full_services;
  set_level_fact(out, F::kFullReady, !full.empty() && alive(full, now), {});
  full_failing_fact(out, now);
  set_level_fact(out, F::kForcedFull, forced_ == ForcedLevel::kFull, {"forced_level", 1.0, 1.0, 0.0, 0.0});
  set_level_fact(out, F::kForcedEfficient, forced_ == ForcedLevel::kEfficient, {"forced_level", 0.0, 0.0, 0.0, 0.0});
  set_level_fact(out, F::kPathFull, path_full_,
                 {"path_level", path_full_ ? 1.0 : 0.0, 1.0, 0.0, age_s(inputs_.control.utime, now)});
  set_level_fact(out, F::kRaisedByPath, raised_by_path_, {});
  set_level_fact(out, F::kSlowProgress, level_selector_.slow_progress(),
                 {"effective_speed_mps", level_selector_.speed_mps(), limits.slow_mps, limits.window_s, planner_age});
  set_level_fact(
      out, F::kManyHazards, level_selector_.many_hazards(),
      {"hazards_per_m", level_selector_.hazards_per_m(), limits.hazards_per_m, limits.window_s, planner_age});
  const bool no_path = inputs_.planner.state == PlannerState::kNoPath && kDriveInProgress.has(state_) && stationary();
  set_level_fact(out, F::kNoPath, no_path, {"planner_state", double(inputs_.planner.state), 0.0, 0.0, planner_age});
  const Monitor* fault = fdir_.stops_only_at(Level::kEfficient, level_);
  set_level_fact(out, F::kLocCamOut, fault != nullptr && (kUnderWayOrFaultStop.has(state_) || state_ == kPaused),
                 fault == nullptr ? Evidence{} : evidence_of(*fault));
  set_level_fact(out, F::kEasyAhead, level_selector_.easy_ahead() && terrain_fresh(),
                 {"terrain_difficulty", inputs_.terrain.difficulty, limits.easy_difficulty, 0.0,
                  age_s(inputs_.terrain.utime, now)});
  return out;
}

void Supervisor::full_failing_fact(LevelFactSet& facts, Utime now) {
  const LevelConfig& limits = level_selector_.config();
  const double starts = failing_starts();
  if (starts >= limits.failing_starts)
    return set_level_fact(facts, LevelFact::kFullFailing, true,
                          {"starts_per_minute", starts, double(limits.failing_starts), 0.0, 0.0});
  set_level_fact(facts, LevelFact::kFullFailing, sweep_s(now) > limits.failing_sweep_s,
                 {"sweep_s", sweep_s(now), limits.failing_sweep_s, 0.0, 0.0});
}

// Largest number of starts or kills over the services of the Full level.
double Supervisor::failing_starts() const {
  int max_count = 0;
  for (const std::string& service : config_.fdir.full_services)
    for (const auto* counts : {&derived_.values().starts, &derived_.values().restart_attempts})
      if (const auto it = counts->find(service); it != counts->end()) max_count = std::max(max_count, it->second);
  return max_count;
}

bool Supervisor::terrain_fresh() const {
  return inputs_.terrain.utime >= 0 &&
         std::abs(inputs_.pose.travelled_m - inputs_.terrain.travelled_m) <= config_.terrain_max_distance_m;
}

double Supervisor::sweep_s(Utime now) const {
  return state_ == kSweeping ? to_seconds(now - since_) : 0.0;
}

// A sweep continues until both sides are known, or until its timeout.
void Supervisor::terrain_fact(FactSet& facts, Utime now) {
  const KnownFractions& known = inputs_.terrain.known;
  const bool swept =
      state_ != kSweeping || known.around >= config_.terrain_known_around || sweep_s(now) > config_.sweep_around_s;
  const bool ahead = known.ahead >= config_.terrain_known_ahead;
  set_fact(facts, Fact::kTerrainKnown, terrain_fresh() && ahead && swept,
           {"terrain_known_ahead", terrain_fresh() ? known.ahead : 0.0, config_.terrain_known_ahead, 0.0,
            age_s(inputs_.terrain.utime, now)});
}

FactSet Supervisor::facts(Utime now) {
  FactSet out;
  const PoseReport& pose = inputs_.pose;
  const double pose_age = age_s(pose.utime, now);
  const double planner_age = age_s(inputs_.planner.utime, now);
  const double control_age = age_s(inputs_.control.utime, now);
  const bool arrived = inputs_.control.path_end && inputs_.planner.goal_distance_m < config_.goal_tolerance_m;
  set_fact(out, Fact::kInputsReady, inputs_ready(now), {});
  set_fact(out, Fact::kPoseFresh, pose.usable && fresh(pose.utime, now, config_.pose_max_age_s),
           {"pose_age_s", pose_age, config_.pose_max_age_s, 0.0, pose_age});
  set_fact(out, Fact::kStationary, stationary(),
           {"speed_mps", pose.speed_mps, config_.stationary_speed_mps, 0, pose_age});
  set_fact(out, Fact::kPlannerRepairing, inputs_.planner.state == PlannerState::kRepairing,
           {"", kNaN, kNaN, 0, planner_age});
  set_fact(out, Fact::kGoalReached, arrived,
           {"goal_distance_m", inputs_.planner.goal_distance_m, config_.goal_tolerance_m, 0.0,
            std::max(planner_age, control_age)});
  set_fact(out, Fact::kLevelFull, level_ == Level::kFull, {"level", level_ == Level::kFull ? 1.0 : 0.0, 1.0, 0.0, 0.0});
  set_fact(out, Fact::kTeleopFresh, fresh(teleop_utime_, now, config_.teleop_max_age_s),
           {"teleop_age_s", age_s(teleop_utime_, now), config_.teleop_max_age_s, 0.0, 0.0});
  terrain_fact(out, now);
  path_facts(out, planner_age);
  fault_facts(out);
  return out;
}

void Supervisor::set_fact(FactSet& facts, Fact fact, bool on, const Evidence& evidence) {
  facts.set(fact, on);
  evidence_[static_cast<size_t>(fact)] = evidence;
}

void Supervisor::set_level_fact(LevelFactSet& facts, LevelFact fact, bool on, const Evidence& evidence) {
  facts.set(fact, on);
  level_evidence_[static_cast<size_t>(fact)] = evidence;
}

void Supervisor::path_facts(FactSet& facts, double planner_age_s) {
  const PlannerReport& planner = inputs_.planner;
  const bool present = planner.path_id >= 0;
  const double distance_m = blocked_in_m();
  const double stop = config_.stop_distance_m;
  // Hysteresis against oscillation by measurement noise; it does not apply to a new path.
  const double clear = planner.path_id == blocked_path_id_ ? stop + config_.stop_hysteresis_m : stop;
  set_fact(facts, Fact::kPathPresent, present, {"path_id", double(planner.path_id), 0.0, 0.0, planner_age_s});
  set_fact(facts, Fact::kPathBlocked, !present || !(distance_m > stop),
           {"blocked_in_m", distance_m, stop, 0.0, planner_age_s});
  set_fact(facts, Fact::kPathClear, present && distance_m > clear,
           {"blocked_in_m", distance_m, clear, 0.0, planner_age_s});
}

void Supervisor::fault_facts(FactSet& facts) {
  const Monitor* blocking = fdir_.first_blocking();
  const Monitor* safe = fdir_.first_safe();
  blocking_fault_ = blocking == nullptr ? "" : blocking->row().id;
  safe_fault_ = safe == nullptr ? "" : safe->row().id;
  set_fact(facts, Fact::kBlockingFault, blocking != nullptr, blocking == nullptr ? Evidence{} : evidence_of(*blocking));
  set_fact(facts, Fact::kSafeFault, safe != nullptr, safe == nullptr ? Evidence{} : evidence_of(*safe));
}

bool Supervisor::inputs_ready(Utime now) const {
  return alive(config_.fdir.required_services, now) && inputs_.pose.usable && inputs_.pose.vo_utime >= 0 &&
         fresh(inputs_.pose.utime, now, config_.pose_max_age_s) &&
         fresh(inputs_.hazards.utime, now, config_.hazards_max_age_s) &&
         fresh(inputs_.planner.utime, now, config_.planner_max_age_s) &&
         fresh(inputs_.control.utime, now, config_.control_max_age_s) &&
         fresh(inputs_.wheels.utime, now, config_.wheels_max_age_s);
}

bool Supervisor::alive(const std::vector<std::string>& services, Utime now) const {
  return std::all_of(services.begin(), services.end(), [&](const std::string& name) {
    const auto it = inputs_.services.find(name);
    return it != inputs_.services.end() && fresh(it->second.utime, now, config_.heartbeat_max_age_s);
  });
}

bool Supervisor::stationary() const {
  return inputs_.pose.speed_mps < config_.stationary_speed_mps &&
         std::abs(inputs_.pose.turn_rate_radps) < config_.stationary_rate_radps;
}

// NaN and a missing path count as blocked at 0 m.
double Supervisor::blocked_in_m() const {
  return inputs_.planner.path_id < 0 || std::isnan(inputs_.planner.blocked_in_m) ? 0.0 : inputs_.planner.blocked_in_m;
}

CommandAnswer Supervisor::answer(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out) {
  if (command.kind == CommandKind::kClearFault) return clear_fault(command, facts, now, out);
  if (command.kind == CommandKind::kForceLevel) return force_level(command, now);
  if (command.kind == CommandKind::kTeleop) return teleop(command, facts, now, out);
  const std::optional<Fact> fact = fact_of(command.kind);
  if (!fact) return {command.id, false, "command not known to this supervisor"};
  return transition(command, *fact, facts, now, out);
}

CommandAnswer Supervisor::transition(const GroundCommand& command, Fact fact, FactSet& facts, Utime now,
                                     SupervisorOutput& out) {
  FactSet with_command = facts;
  with_command.insert(fact);
  const Transition* row = next_transition(state_, with_command);
  if (row == nullptr || !row->required.has(fact)) return {command.id, false, refusal_reason(state_, facts, fact)};
  fire(*row, now, out);
  return {command.id, true, ""};
}

// The first command enters TELEOP, the following ones keep it fresh.
CommandAnswer Supervisor::teleop(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out) {
  const CommandAnswer answer = state_ == kTeleop ? CommandAnswer{command.id, true, ""}
                                                 : transition(command, Fact::kCommandTeleop, facts, now, out);
  if (!answer.accepted) return answer;
  teleop_utime_ = now;
  facts.insert(Fact::kTeleopFresh);
  return answer;
}

CommandAnswer Supervisor::force_level(const GroundCommand& command, Utime now) {
  const bool known = command.level == ForcedLevel::kEfficient || command.level == ForcedLevel::kFull ||
                     command.level == ForcedLevel::kAuto;
  if (!known) return {command.id, false, "no such level"};
  if (command.level == ForcedLevel::kFull && full_services_wanted() && !level_facts(now).has(LevelFact::kFullReady))
    return {command.id, false, "the services of the Full level are not running"};
  forced_ = command.level;
  return {command.id, true, ""};
}

CommandAnswer Supervisor::clear_fault(const GroundCommand& command, FactSet& facts, Utime now, SupervisorOutput& out) {
  // Accepted, it also resets all counters; rows about counters are judged without them.
  const DerivedValueTracker derived = derived_;
  const ServiceRestarter restarter = restarter_;
  derived_.reset_counters();
  restarter_.reset();
  derived_.set_restart_attempts(restarter_.restart_attempts(now));
  Fdir::Cleared cleared = fdir_.clear(command.target, monitor_context(now));
  if (!cleared.refusal_reason.empty()) {
    derived_ = derived;
    restarter_ = restarter;
    return {command.id, false, cleared.refusal_reason};
  }
  out.faults.insert(out.faults.end(), cleared.change.begin(), cleared.change.end());
  fault_facts(facts);
  return {command.id, true, ""};
}

void Supervisor::fire(const Transition& row, Utime now, SupervisorOutput& out) {
  StateChange change{state_, row.to, level_, level_, row.cause, evidence_[static_cast<size_t>(row.evidence)]};
  if (row.required.has(Fact::kBlockingFault)) change.cause = blocking_fault_;
  if (row.required.has(Fact::kSafeFault)) change.cause = safe_fault_;
  if (state_ == kDriving && row.to == kHazardStop) ++hazard_stops_;
  if (row.to == kHazardStop) blocked_path_id_ = inputs_.planner.path_id;
  if (row.to == kFaultStop) derived_.on_fault_stop();
  if (state_ == kStandby) level_selector_.reset();
  state_ = row.to;
  since_ = now;
  last_change_ = change;
  out.changes.push_back(change);
}

void Supervisor::fire(const LevelTransition& row, SupervisorOutput& out) {
  const StateChange change{state_, state_,    level_,
                           row.to, row.cause, level_evidence_[static_cast<size_t>(row.evidence)]};
  raised_by_path_ = row.to == Level::kFull && row.evidence == LevelFact::kPathFull;
  level_ = row.to;
  level_selector_.reset();
  last_change_ = change;
  out.changes.push_back(change);
}

Permit Supervisor::permit(FactSet facts, Utime now) const {
  if (permit_allowed(state_, facts)) return {true, speed_limit_mps(), now + to_utime(config_.permit_validity_s), ""};
  return {false, 0.0, now, state_ == kDriving || state_ == kTeleop ? "guard" : name(state_)};
}

double Supervisor::speed_limit_mps() const {
  if (state_ == kTeleop) return std::min(config_.teleop_speed_mps, fdir_.speed_limit_mps());
  // At any time the rover can brake before the stopping distance; a plan that comes a little late costs no stop.
  const double free_m = std::max(0.0, blocked_in_m() - config_.stop_distance_m);
  const double braking_mps = std::sqrt(2.0 * config_.deceleration_mps2 * free_m);
  // What a look from afar did not show is seen once more before the rover is there.
  const double looking_mps =
      frame_interval_s_ > 0.0 ? config_.advance_per_frame_m / frame_interval_s_ : kMinApproachMps;
  return std::min(
      {config_.max_speed_mps, std::max(braking_mps, kMinApproachMps), looking_mps, fdir_.speed_limit_mps()});
}

void Supervisor::restore(const std::optional<PersistentState>& saved) {
  restored_ = true;
  if (!saved) return;
  const PersistentState& persistent_state = *saved;
  restored_utime_ = persistent_state.utime;
  state_ = persistent_state.state;
  if (kUnderWayOrFaultStop.has(state_)) state_ = kFaultStop;
  if (state_ == kTeleop) state_ = kStandby;
  level_ = persistent_state.level;
  raised_by_path_ = persistent_state.raised_by_path;
  path_full_ = persistent_state.path_full;
  forced_ = persistent_state.forced;
  hazard_stops_ = persistent_state.hazard_stops;
  backtracking_path_id_ = persistent_state.backtracking_path_id;
  fdir_.restore(persistent_state.faults);
  derived_.restore(persistent_state.heat, persistent_state.counters);
  restarter_.restore(persistent_state.restart_attempts);
  last_change_ = {persistent_state.state, state_, level_, level_, "supervisor_restarted", {}};
}

PersistentState Supervisor::persistent_state() const {
  return {state_,
          level_,
          raised_by_path_,
          path_full_,
          forced_,
          hazard_stops_,
          backtracking_path_id_,
          fdir_.active(),
          derived_.counters(),
          restarter_.attempts(),
          derived_.heat(),
          kNever};
}

}  // namespace rover::supervisor
