// Which rocks the rover met, which of them its hazard maps had shown, and which it drove at unseen.
#pragma once

#include <limits>
#include <unordered_map>
#include <vector>

#include "tools/report/track.hpp"

namespace rover::report {

constexpr double kHazardRockM = 0.15;      // tall from here on: a hazard
constexpr double kMustSeeRockM = 0.20;     // must never come under the rover unseen
constexpr double kEncounterM = 1.0;        // rim this near to the driven or the planned line: encountered
constexpr double kDetectionReachM = 0.25;  // from the rim to the middle of a hazard cell that stands for the rock

// Rocks by place.
class RockIndex {
 public:
  explicit RockIndex(std::vector<Rock> rocks);
  const std::vector<Rock>& rocks() const { return rocks_; }
  // Indices of the rocks whose rim is within reach of p.
  std::vector<size_t> near(const Eigen::Vector2d& p, double reach_m) const;

 private:
  static std::int64_t key(int ix, int iy);
  std::vector<Rock> rocks_;
  double largest_radius_m_ = 0.0;
  std::unordered_map<std::int64_t, std::vector<size_t>> cells_;
};

struct RockVerdict {
  Rock rock;
  bool encountered = false;
  double detected_s = kInfinity;  // release of the first hazard map that shows it
  double swept_s = kInfinity;     // first time under the footprint
  bool missed() const { return rock.height_m >= kMustSeeRockM && swept_s < kInfinity && detected_s > swept_s; }
};

// Where a cell of a hazard map truly is: the ground point below it, seen from the true pose at the exposure.
Eigen::Vector2d cell_in_map(const HazardCell& cell, const Eigen::Isometry3d& T_map_body, double origin_height_m);

// One verdict for each hazard rock among `rocks`.
std::vector<RockVerdict> judge_rocks(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                     const Footprint& footprint, const std::vector<Rock>& rocks);

}  // namespace rover::report
