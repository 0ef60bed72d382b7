// Detection of rocks: encountered, detected by hazard maps, missed.
#pragma once

#include <limits>
#include <unordered_map>
#include <vector>

#include "tools/report/track.hpp"

namespace rover::report {

constexpr double kHazardRockM = 0.15;       // minimum height of a hazard
constexpr double kMustSeeRockM = 0.20;      // minimum height of a rock that must be detected
constexpr double kEncounterM = 1.0;         // maximum distance of the rim from the driven or planned path
constexpr double kDetectionRadiusM = 0.25;  // maximum distance of a hazard cell's centre from the rim

// Those of at least kHazardRockM.
std::vector<Rock> hazards_of(const std::vector<Rock>& rocks);

// Spatial index of rocks.
class RockIndex {
 public:
  explicit RockIndex(std::vector<Rock> rocks);
  const std::vector<Rock>& rocks() const { return rocks_; }
  // Indices of the rocks whose rim is within radius_m of p.
  std::vector<size_t> near(const Eigen::Vector2d& p, double radius_m) const;

 private:
  static std::int64_t key(int ix, int iy);
  std::vector<Rock> rocks_;
  double largest_radius_m_ = 0.0;
  std::unordered_map<std::int64_t, std::vector<size_t>> cells_;
};

struct RockResult {
  Rock rock;
  bool encountered = false;
  double detected_s = kInfinity;  // release of the first hazard map that contains it
  double swept_s = kInfinity;     // first time under the footprint
  bool missed() const { return rock.height_m >= kMustSeeRockM && swept_s < kInfinity && detected_s > swept_s; }
};

// By 2 cm or 1 deg, the step at which the true track is sampled.
bool far_apart(const Pose2& a, const Pose2& b);

// True position of a hazard cell: the ground point below it, by the true pose at the exposure.
Eigen::Vector2d cell_in_map(const HazardCell& cell, const Eigen::Isometry3d& T_map_body, double origin_height_m);

// One result for each hazard rock in `rocks`.
std::vector<RockResult> evaluate_rocks(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                       const Footprint& footprint, const std::vector<Rock>& rocks);

}  // namespace rover::report
