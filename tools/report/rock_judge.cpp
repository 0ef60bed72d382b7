#include "tools/report/rock_judge.hpp"

#include <algorithm>
#include <cmath>

namespace rover::report {
namespace {

constexpr double kBucketM = 1.0;

// Poses of the true track at most 2 cm and 1 deg apart are enough for a footprint in motion.
constexpr double kPoseStepM = 0.02;
const double kPoseStepRad = to_rad(1.0);

bool far_apart(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) >= kPoseStepM ||
         std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)) >= kPoseStepRad;
}

void judge_sweep(const RunRecord& run, const Window& window, const Footprint& footprint, const RockIndex& field,
                 std::vector<RockVerdict>& verdicts) {
  const double reach = std::max(kEncounterM, std::hypot(footprint.half_length_m, footprint.half_width_m));
  Pose2 last{kInfinity, kInfinity, 0.0};
  for (const TruthSample& sample : run.truth) {
    if (!window.contains(sample.t_s)) continue;
    const Pose2 pose = planar(sample.T_map_body);
    if (!far_apart(pose, last)) continue;
    last = pose;
    const Eigen::Vector2d origin(pose.x_m, pose.y_m);
    for (const size_t i : field.near(origin, reach)) {
      RockVerdict& verdict = verdicts[i];
      const Eigen::Vector2d center(verdict.rock.x_m, verdict.rock.y_m);
      verdict.encountered |= (center - origin).norm() <= verdict.rock.radius_m + kEncounterM;
      const double gap =
          distance_to_box_m(transform(inverse(pose), center), footprint.half_length_m, footprint.half_width_m);
      if (gap < verdict.rock.radius_m) verdict.swept_s = std::min(verdict.swept_s, sample.t_s);
    }
  }
}

void judge_detection(const RunRecord& run, const TrueTrack& truth, double origin_height_m, const RockIndex& field,
                     std::vector<RockVerdict>& verdicts) {
  for (const HazardMap& map : run.hazards) {
    if (map.cells.empty() || truth.empty()) continue;
    const Eigen::Isometry3d T_map_body = truth.at(map.t_s);
    for (const HazardCell& cell : map.cells)
      for (const size_t i : field.near(cell_in_map(cell, T_map_body, origin_height_m), kDetectionReachM))
        verdicts[i].detected_s = std::min(verdicts[i].detected_s, map.released_s);
  }
}

}  // namespace

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

std::vector<size_t> RockIndex::near(const Eigen::Vector2d& p, double reach_m) const {
  const double r = reach_m + largest_radius_m_;
  const auto cell = [](double v) { return static_cast<int>(std::floor(v / kBucketM)); };
  std::vector<size_t> found;
  for (int ix = cell(p.x() - r); ix <= cell(p.x() + r); ++ix)
    for (int iy = cell(p.y() - r); iy <= cell(p.y() + r); ++iy) {
      const auto it = cells_.find(key(ix, iy));
      if (it == cells_.end()) continue;
      for (const size_t i : it->second)
        if (std::hypot(rocks_[i].x_m - p.x(), rocks_[i].y_m - p.y()) <= rocks_[i].radius_m + reach_m)
          found.push_back(i);
    }
  return found;
}

Eigen::Vector2d cell_in_map(const HazardCell& cell, const Eigen::Isometry3d& T_map_body, double origin_height_m) {
  return (T_map_body * Eigen::Vector3d(cell.p_body.x(), cell.p_body.y(), -origin_height_m)).head<2>();
}

std::vector<RockVerdict> judge_rocks(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                     const Footprint& footprint, const std::vector<Rock>& rocks) {
  std::vector<Rock> hazards;
  std::copy_if(rocks.begin(), rocks.end(), std::back_inserter(hazards),
               [](const Rock& rock) { return rock.height_m >= kHazardRockM; });
  const RockIndex field(hazards);
  std::vector<RockVerdict> verdicts;
  for (const Rock& rock : hazards) verdicts.push_back({rock});
  judge_sweep(run, window, footprint, field, verdicts);
  judge_detection(run, truth, footprint.origin_height_m, field, verdicts);
  if (!run.global_paths.empty())
    for (RockVerdict& verdict : verdicts)
      verdict.encountered |= distance_m(run.global_paths.back().points, {verdict.rock.x_m, verdict.rock.y_m}) <=
                             verdict.rock.radius_m + kEncounterM;
  return verdicts;
}

}  // namespace rover::report
