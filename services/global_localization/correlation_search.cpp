#include "global_localization/correlation_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace rover::global {
namespace {

// A sample rotated into map axes, with its cell when the template is at the window's lower left corner.
struct PlacedSample {
  int column, row;
  double gx, gy;
};

std::vector<PlacedSample> place_samples(const TerrainTemplate& terrain, const Lattice& lattice,
                                        const CandidatePose& corner) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(corner.yaw_rad).toRotationMatrix();
  std::vector<PlacedSample> out;
  for (const TerrainSample& sample : terrain.samples) {
    const Eigen::Vector2d p = corner.center_map + R * sample.p, g = R * sample.g;
    out.push_back({static_cast<int>(std::floor((p.x() - lattice.x0_m) / lattice.cell_m)),
                   static_cast<int>(std::floor((p.y() - lattice.y0_m) / lattice.cell_m)), g.x(), g.y()});
  }
  return out;
}

double score_at(const PlaneField& field, const std::vector<PlacedSample>& samples, int du, int dv, double min_overlap) {
  CorrelationSums sums;
  for (const PlacedSample& s : samples) {
    if (!field.lattice.contains(s.column + du, s.row + dv)) continue;
    const size_t i = field.lattice.index(s.column + du, s.row + dv);
    if (field.known[i] != 0) sums.add(s.gx, s.gy, field.gx[i], field.gy[i]);
  }
  return sums.count >= min_overlap * static_cast<double>(samples.size()) ? sums.correlation() : -1.0;
}

// Best yaw and score at each cell of the window, row by row.
std::vector<Peak> best_yaws(const OrbitalSection& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                            int steps) {
  const Lattice& lattice = orbital.field().lattice;
  const int side = 2 * steps + 1;
  const int yaw_steps = static_cast<int>(std::ceil(window.half_width_rad / window.yaw_step_rad));
  std::vector<Peak> best(static_cast<size_t>(side) * static_cast<size_t>(side));
  for (int yaw_index = -yaw_steps; yaw_index <= yaw_steps; ++yaw_index) {
    CandidatePose corner = window.prior;
    corner.center_map.array() -= steps * lattice.cell_m;
    corner.yaw_rad += window.half_width_rad * yaw_index / std::max(yaw_steps, 1);
    const std::vector<PlacedSample> samples = place_samples(terrain, lattice, corner);
    for (int dv = 0; dv < side; ++dv)
      for (int du = 0; du < side; ++du) {
        Peak& peak = best[static_cast<size_t>(dv) * static_cast<size_t>(side) + static_cast<size_t>(du)];
        const double score = score_at(orbital.field(), samples, du, dv, window.min_overlap);
        if (score <= peak.score) continue;
        peak = {{corner.center_map + lattice.cell_m * Eigen::Vector2d(du, dv), corner.yaw_rad}, score};
      }
  }
  return best;
}

}  // namespace

std::vector<Peak> find_peaks(const OrbitalSection& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                             double min_distance_m, int max_peaks) {
  const int steps = static_cast<int>(std::ceil(window.half_width_m / orbital.field().lattice.cell_m));
  std::vector<Peak> all = best_yaws(orbital, terrain, window, steps);
  std::stable_sort(all.begin(), all.end(), [](const Peak& a, const Peak& b) { return a.score > b.score; });
  std::vector<Peak> peaks;
  for (const Peak& peak : all) {
    if (peak.score <= 0.0 || static_cast<int>(peaks.size()) >= max_peaks) break;
    const bool apart = std::all_of(peaks.begin(), peaks.end(), [&](const Peak& higher) {
      return (higher.pose.center_map - peak.pose.center_map).norm() > min_distance_m;
    });
    if (apart) peaks.push_back(peak);
  }
  return peaks;
}

}  // namespace rover::global
