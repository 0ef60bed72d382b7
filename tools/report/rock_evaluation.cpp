#include "tools/report/rock_evaluation.hpp"

#include <algorithm>
#include <cmath>

namespace rover::report {
namespace {

constexpr double kBucketM = 1.0;

constexpr double kPoseStepM = 0.02;
const double kPoseStepRad = to_rad(1.0);

void evaluate_sweep(const RunRecord& run, const Window& window, const Footprint& footprint, const RockIndex& field,
                    std::vector<RockResult>& results) {
  const double radius = std::max(kEncounterM, std::hypot(footprint.half_length_m, footprint.half_width_m));
  Pose2 last{kInfinity, kInfinity, 0.0};
  for (const TruthSample& sample : run.truth) {
    if (!window.contains(sample.t_s)) continue;
    const Pose2 pose = planar(ground_pose(sample.T_map_body, footprint.origin_height_m));
    if (!far_apart(pose, last)) continue;
    last = pose;
    const Eigen::Vector2d origin(pose.x_m, pose.y_m);
    for (const size_t i : field.near(origin, radius)) {
      RockResult& result = results[i];
      const Eigen::Vector2d center(result.rock.x_m, result.rock.y_m);
      result.encountered |= (center - origin).norm() <= result.rock.radius_m + kEncounterM;
      const double gap =
          distance_to_box_m(transform(inverse(pose), center), footprint.half_length_m, footprint.half_width_m);
      if (gap < result.rock.radius_m) result.swept_s = std::min(result.swept_s, sample.t_s);
    }
  }
}

void evaluate_detection(const RunRecord& run, const TrueTrack& truth, double origin_height_m, const RockIndex& field,
                        std::vector<RockResult>& results) {
  for (const HazardMap& map : run.hazards) {
    if (map.cells.empty() || truth.empty()) continue;
    const Eigen::Isometry3d T_map_body = truth.at(map.t_s);
    for (const HazardCell& cell : map.cells)
      for (const size_t i : field.near(cell_in_map(cell, T_map_body, origin_height_m), kDetectionRadiusM))
        results[i].detected_s = std::min(results[i].detected_s, map.released_s);
  }
}

}  // namespace

std::vector<Rock> hazards_of(const std::vector<Rock>& rocks) {
  std::vector<Rock> hazards;
  std::copy_if(rocks.begin(), rocks.end(), std::back_inserter(hazards),
               [](const Rock& rock) { return rock.height_m >= kHazardRockM; });
  return hazards;
}

bool far_apart(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) >= kPoseStepM ||
         std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)) >= kPoseStepRad;
}

RockIndex::RockIndex(std::vector<Rock> rocks) : rocks_(std::move(rocks)) {
  for (size_t i = 0; i < rocks_.size(); ++i) {
    const int ix = static_cast<int>(std::floor(rocks_[i].x_m / kBucketM));
    const int iy = static_cast<int>(std::floor(rocks_[i].y_m / kBucketM));
    cells_[key(ix, iy)].push_back(i);
    largest_radius_m_ = std::max(largest_radius_m_, rocks_[i].radius_m);
  }
}

std::int64_t RockIndex::key(int ix, int iy) {
  return static_cast<std::int64_t>(ix) * 0x100000000 + iy;
}

std::vector<size_t> RockIndex::near(const Eigen::Vector2d& p, double radius_m) const {
  const double r = radius_m + largest_radius_m_;
  const auto cell = [](double v) { return static_cast<int>(std::floor(v / kBucketM)); };
  std::vector<size_t> found;
  for (int ix = cell(p.x() - r); ix <= cell(p.x() + r); ++ix)
    for (int iy = cell(p.y() - r); iy <= cell(p.y() + r); ++iy) {
      const auto it = cells_.find(key(ix, iy));
      if (it == cells_.end()) continue;
      for (const size_t i : it->second)
        if (std::hypot(rocks_[i].x_m - p.x(), rocks_[i].y_m - p.y()) <= rocks_[i].radius_m + radius_m)
          found.push_back(i);
    }
  return found;
}

Eigen::Vector2d cell_in_map(const HazardCell& cell, const Eigen::Isometry3d& T_map_body, double origin_height_m) {
  return (T_map_body * Eigen::Vector3d(cell.p_body.x(), cell.p_body.y(), -origin_height_m)).head<2>();
}

std::vector<RockResult> evaluate_rocks(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                       const Footprint& footprint, const std::vector<Rock>& rocks) {
  const std::vector<Rock> hazards = hazards_of(rocks);
  const RockIndex field(hazards);
  std::vector<RockResult> results;
  for (const Rock& rock : hazards) results.push_back({rock});
  evaluate_sweep(run, window, footprint, field, results);
  evaluate_detection(run, truth, footprint.origin_height_m, field, results);
  for (const PathRecord& path : followed_paths(run, window))
    for (RockResult& result : results)
      result.encountered |=
          distance_m(path.points, {result.rock.x_m, result.rock.y_m}) <= result.rock.radius_m + kEncounterM;
  return results;
}

}  // namespace rover::report
