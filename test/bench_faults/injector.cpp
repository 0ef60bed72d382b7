#include "test/bench_faults/injector.hpp"

#include <algorithm>
#include <cstdio>

namespace rover::bench_faults {
namespace {

constexpr double kSettleS = 0.5;  // minimum recovery time after the cause
constexpr double kMostRecoveryS = 150.0;
constexpr double kLostS = 400.0;
constexpr double kSeekS = 120.0;  // timeout for a phase, then the operator sends another path
constexpr double kRepairedS = 10.0;
constexpr double kWayLeftM = 4.0;  // minimum remaining distance, so that the goal is not reached meanwhile
constexpr Utime kRockPeriodUs = 8'000'000;

bool is_before_rocks(Phase phase) {
  return phase == Phase::kHazardStop || phase == Phase::kRepair;
}

}  // namespace

Injector::Injector(const std::vector<Case>& cases, int per_row, size_t most, double rocks_at_m, const Observer& seen,
                   Hands& hands, Field& field, Log& log, std::uint64_t seed)
    : cases_(cases), rocks_at_m_(rocks_at_m), seen_(seen), hands_(hands), field_(field), log_(log), random_(seed) {
  plan(per_row, most);
}

void Injector::plan(int per_row, size_t most) {
  for (const Case& what : cases_)
    for (int i = 0; i < per_row; ++i) {
      const size_t turn = static_cast<size_t>(i);
      const size_t phases = what.phases.size();
      // Rotate motors and services over the phases.
      const std::string who = what.who.empty() ? "" : what.who[(turn + turn / phases) % what.who.size()];
      const Cause& cause = what.causes[turn / phases % what.causes.size()];
      plan_.push_back({&what, &cause, what.phases[turn % phases], who, i});
    }
  for (size_t i = plan_.size(); i > 1; --i) std::swap(plan_[i - 1], plan_[random_() % i]);
  if (plan_.size() > most) plan_.resize(most);
}

void Injector::step(Utime now) {
  hands_.now = now;
  if (well()) well_at_ = now;
  if (active_) return watch();
  if (next_ >= plan_.size() || !well()) return;
  // The first remaining injection for the current phase, else wait for the phase of the next one.
  const auto from = plan_.begin() + static_cast<std::ptrdiff_t>(next_);
  const auto fits = std::find_if(from, plan_.end(), [&](const Planned& planned) { return is_time_for(planned); });
  if (fits == plan_.end()) return seek(*from);
  std::iter_swap(from, fits);
  begin(plan_[next_++]);
}

bool Injector::is_time_for(const Planned& wanted) const {
  if (seen_.phase() != wanted.phase) return false;
  if ((seen_.state().level == supervisor_state_t::FULL) != wanted.what->full) return false;
  if (wanted.phase == Phase::kStandstill) return true;
  if (wanted.phase == Phase::kStraight && hands_.rover.speed_mps() < 0.05) return false;
  return seen_.planner().goal_distance_m > kWayLeftM;
}

void Injector::seek(const Planned& wanted) {
  const bool stand = wanted.phase == Phase::kStandstill;
  hands_.ground.wish(stand ? Wish::kStand : Wish::kDrive);
  if (seeking_since_ == 0) seeking_since_ = hands_.now;
  const Utime sought = hands_.now - seeking_since_;
  const bool full = seen_.state().level == supervisor_state_t::FULL;
  if (full != wanted.what->full && hands_.now % 1'000'000 == 0)
    hands_.ground.command(ground_command_t::FORCE_LEVEL, "",
                          wanted.what->full ? ground_command_t::FULL : ground_command_t::EFFICIENT);
  const bool repairs = seen_.phase() == Phase::kRepair;
  if (is_before_rocks(wanted.phase) && sought % kRockPeriodUs == 0 && (repairs || seen_.phase() == Phase::kStraight))
    field_.lay_rocks(hands_.rover.pose(), rocks_at_m_);
  // A repaired path leads far; another one is the global path again.
  if (to_seconds(sought) < (repairs && wanted.phase == Phase::kStraight ? kRepairedS : kSeekS)) return;
  leave();
  seeking_since_ = 0;
}

// The next drive starts with another path, away from the rocks placed here.
void Injector::leave() {
  hands_.ground.forget_path();
  hands_.ground.command(ground_command_t::STOP);
}

void Injector::begin(const Planned& planned) {
  active_ = planned;
  ended_ = false;
  begun_at_ = hands_.now;
  seeking_since_ = 0;
  injection_t note{};
  note.injection_id = static_cast<std::int64_t>(next_);
  note.target = planned.row();
  note.fault = planned.cause->text;
  note.header.publisher = kPhaseNames[static_cast<size_t>(planned.phase)];
  note.from_utime = hands_.now;
  log_.note(kInjectionBegins, note);
  std::printf("%lld BENCH injection=%zu row=%s phase=%s cause=%s\n", static_cast<long long>(hands_.now), next_,
              planned.row().c_str(), note.header.publisher.c_str(), note.fault.c_str());
  hands_.ground.wish(planned.phase == Phase::kStandstill ? Wish::kStand : Wish::kDrive);
  planned.cause->begin(hands_, planned.who, planned.turn);
}

void Injector::watch() {
  const Planned& p = *active_;
  const double age_s = to_seconds(hands_.now - begun_at_);
  if (!ended_ && p.cause->go_on) p.cause->go_on(hands_, p.who, age_s);
  if (!ended_ && (age_s >= p.cause->longest_s || seen_.active_faults().contains(p.row()))) end();
  if (!ended_ || to_seconds(hands_.now - ended_at_) < kSettleS) return;
  const bool late = to_seconds(hands_.now - ended_at_) > kMostRecoveryS;
  if (!well() && !late) return;
  if (late) {
    ++stuck_;
    std::printf("%lld BENCH injection=%zu row=%s STUCK\n", static_cast<long long>(hands_.now), next_, p.row().c_str());
    leave();
  }
  injection_t note{};
  note.injection_id = static_cast<std::int64_t>(next_);
  note.target = p.row();
  note.from_utime = begun_at_;
  note.until_utime = ended_at_;
  log_.note(kInjectionOver, note);
  if (is_before_rocks(p.phase)) leave();
  // Reset counters over time or distance, as an operator does after a fault.
  hands_.ground.command(ground_command_t::CLEAR_FAULT, p.row());
  active_.reset();
}

void Injector::end() {
  if (active_->cause->end) active_->cause->end(hands_, active_->who);
  ended_ = true;
  ended_at_ = hands_.now;
}

bool Injector::lost() const {
  return to_seconds(hands_.now - well_at_) > kLostS;
}

// No active row, and the supervisor waits neither for services nor for the operator.
bool Injector::well() const {
  const std::int8_t state = seen_.state().state;
  return seen_.active_faults().empty() && state != supervisor_state_t::BOOT && state != supervisor_state_t::SAFE &&
         state != supervisor_state_t::FAULT_STOP;
}

}  // namespace rover::bench_faults
