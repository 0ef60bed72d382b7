// What the choice of the level is made from: effective speed and hazards over a window, difficulty of the ground ahead.
// (Azkarate et al. 2020: the level is chosen on the ground from the orbital map, or on board from the effective speed
// and the difficulty met.)
#pragma once

#include <deque>

#include "supervisor/inputs.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct LevelConfig {
  double window_s = 120.0;
  double slow_mps = 0.06;      // progress towards the goal over the window
  double hazards_per_m = 0.5;  // stops and repairs
  double least_hazards = 4;    // before they count
  double easy_difficulty = 0.25;
  double easy_way_m = 8.0;
  double failing_starts = 2.0;    // of one of the Full level's services within a minute: down
  double failing_sweep_s = 40.0;  // a sweep that shows nothing for that long: down
};

class LevelJudge {
 public:
  explicit LevelJudge(const LevelConfig& config) : config_(config) {}

  // Each tick. `under_way`: time and way count; otherwise they stand still.
  void step(Utime now, const Inputs& in, int hazard_stops, bool under_way);
  // The level has changed, or another path is driven: the windows start anew.
  void restart();

  bool slow_progress() const { return window_full() && speed_mps() < config_.slow_mps; }
  bool many_hazards() const { return hazards() >= config_.least_hazards && hazards_per_m() > config_.hazards_per_m; }
  bool easy_ahead() const { return easy_way_m_ >= config_.easy_way_m; }
  double speed_mps() const;
  double hazards_per_m() const;
  double easy_way_m() const { return easy_way_m_; }
  const LevelConfig& config() const { return config_; }

 private:
  struct Sample {
    double time_s;  // under way
    double goal_distance_m;
    int hazards;  // stops and repairs since the start
  };
  bool window_full() const;
  int hazards() const;
  void judge_terrain(const Inputs& in);

  LevelConfig config_;
  std::deque<Sample> window_;
  Utime last_ = kNever;
  double time_s_ = 0.0;
  double easy_way_m_ = 0.0;
  double travelled_m_ = kNaN;
};

}  // namespace rover::supervisor
