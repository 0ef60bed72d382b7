// Measures for the selection of the autonomy level: effective speed and hazards over a window, terrain difficulty.
// Azkarate et al. 2020: the level is set by the ground from the orbital map, or on board from these measures.
#pragma once

#include <deque>

#include "supervisor/inputs.hpp"
#include "supervisor/state_machine.hpp"

namespace rover::supervisor {

struct LevelConfig {
  double window_s = 120.0;
  double slow_mps = 0.06;      // lower progress towards the goal raises the level
  double hazards_per_m = 0.5;  // more hazard stops and repairs per metre raise the level
  int min_hazards = 4;         // minimum number in the window
  double easy_difficulty = 0.25;
  double easy_distance_m = 8.0;
  int failing_starts = 2;         // starts of one Full-level service within a minute: lower the level
  double failing_sweep_s = 40.0;  // sweep without known ground for that long: lower the level
  double linger_s = 10.0;         // services of the Full level run on for so long unwanted
};

class LevelSelector {
 public:
  explicit LevelSelector(const LevelConfig& config) : config_(config) {}

  // Each tick. Time and samples accumulate only while `drive_in_progress`.
  void step(Utime now, const Inputs& inputs, int hazard_stops, bool drive_in_progress);
  // Clears the windows, after a level change or at the start of a drive.
  void reset();

  bool slow_progress() const { return window_full() && speed_mps() < config_.slow_mps; }
  bool many_hazards() const { return hazards() >= config_.min_hazards && hazards_per_m() > config_.hazards_per_m; }
  bool easy_ahead() const { return easy_distance_m_ >= config_.easy_distance_m; }
  double speed_mps() const;
  double hazards_per_m() const;
  double easy_distance_m() const { return easy_distance_m_; }
  const LevelConfig& config() const { return config_; }

 private:
  struct Sample {
    double time_s;  // accumulated time of driving
    double goal_distance_m;
    int hazards;  // cumulative stops and repairs
  };
  bool window_full() const;
  int hazards() const;
  void update_terrain(const Inputs& inputs);

  LevelConfig config_;
  std::deque<Sample> window_;  // on one global path
  std::int64_t global_path_id_ = -1;
  Utime last_step_ = kNever;
  double time_s_ = 0.0;
  double easy_distance_m_ = 0.0;
  double travelled_m_ = kNaN;
};

}  // namespace rover::supervisor
