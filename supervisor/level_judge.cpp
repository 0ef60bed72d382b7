#include "supervisor/level_judge.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

constexpr double kSampleS = 1.0;
constexpr double kLeastWayM = 1.0;  // hazards on less are taken as on this

}  // namespace

void LevelJudge::restart() {
  window_.clear();
  easy_way_m_ = 0.0;
}

void LevelJudge::step(Utime now, const Inputs& in, int hazard_stops, bool under_way) {
  if (under_way && last_ != kNever) time_s_ += std::min(to_seconds(now - last_), kSampleS);
  last_ = now;
  judge_terrain(in);
  if (!under_way || !std::isfinite(in.planner.goal_distance_m)) return;
  if (!window_.empty() && time_s_ - window_.back().time_s < kSampleS) return;
  window_.push_back({time_s_, in.planner.goal_distance_m, hazard_stops + in.planner.replans});
  while (time_s_ - window_.front().time_s > config_.window_s) window_.pop_front();
}

// Ground that is not known, or no number, is not easy.
void LevelJudge::judge_terrain(const Inputs& in) {
  const double way = std::isnan(travelled_m_) ? 0.0 : in.pose.travelled_m - travelled_m_;
  travelled_m_ = in.pose.travelled_m;
  const bool easy = in.terrain.difficulty < config_.easy_difficulty;
  easy_way_m_ = easy ? easy_way_m_ + std::max(way, 0.0) : 0.0;
}

bool LevelJudge::window_full() const {
  return !window_.empty() && window_.back().time_s - window_.front().time_s >= config_.window_s - 2.0 * kSampleS;
}

double LevelJudge::speed_mps() const {
  if (window_.size() < 2) return kNaN;
  const double time = window_.back().time_s - window_.front().time_s;
  return (window_.front().goal_distance_m - window_.back().goal_distance_m) / time;
}

int LevelJudge::hazards() const {
  return window_.empty() ? 0 : window_.back().hazards - window_.front().hazards;
}

double LevelJudge::hazards_per_m() const {
  if (window_.empty()) return 0.0;
  const double way = window_.front().goal_distance_m - window_.back().goal_distance_m;
  return hazards() / std::max(way, kLeastWayM);
}

}  // namespace rover::supervisor
