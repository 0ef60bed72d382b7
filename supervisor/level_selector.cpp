#include "supervisor/level_selector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rover::supervisor {
namespace {

constexpr double kSampleS = 1.0;
constexpr double kMinDistanceM = 1.0;  // lower bound of the divisor

}  // namespace

void LevelSelector::reset() {
  window_.clear();
  easy_distance_m_ = 0.0;
}

void LevelSelector::step(Utime now, const Inputs& inputs, int hazard_stops, bool drive_in_progress) {
  if (drive_in_progress && last_step_ != kNever) time_s_ += std::min(to_seconds(now - last_step_), kSampleS);
  last_step_ = now;
  update_terrain(inputs);
  if (!drive_in_progress || !std::isfinite(inputs.planner.goal_distance_m)) return;
  // The distance to another goal is not progress.
  if (std::exchange(global_path_id_, inputs.planner.global_path_id) != inputs.planner.global_path_id) window_.clear();
  if (!window_.empty() && time_s_ - window_.back().time_s < kSampleS) return;
  window_.push_back({time_s_, inputs.planner.goal_distance_m, hazard_stops + inputs.planner.replans});
  while (time_s_ - window_.front().time_s > config_.window_s) window_.pop_front();
}

// NaN (unknown ground) is not easy.
void LevelSelector::update_terrain(const Inputs& inputs) {
  const double distance_m = std::isnan(travelled_m_) ? 0.0 : inputs.pose.travelled_m - travelled_m_;
  travelled_m_ = inputs.pose.travelled_m;
  const bool easy = inputs.terrain.difficulty < config_.easy_difficulty;
  easy_distance_m_ = easy ? easy_distance_m_ + std::max(distance_m, 0.0) : 0.0;
}

bool LevelSelector::window_full() const {
  return !window_.empty() && window_.back().time_s - window_.front().time_s >= config_.window_s - 2.0 * kSampleS;
}

double LevelSelector::speed_mps() const {
  if (window_.size() < 2) return kNaN;
  const double time = window_.back().time_s - window_.front().time_s;
  return (window_.front().goal_distance_m - window_.back().goal_distance_m) / time;
}

int LevelSelector::hazards() const {
  return window_.empty() ? 0 : window_.back().hazards - window_.front().hazards;
}

double LevelSelector::hazards_per_m() const {
  if (window_.empty()) return 0.0;
  const double distance_m = window_.front().goal_distance_m - window_.back().goal_distance_m;
  return hazards() / std::max(distance_m, kMinDistanceM);
}

}  // namespace rover::supervisor
