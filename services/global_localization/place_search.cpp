#include "global_localization/place_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace rover::global {
namespace {

// A sample turned into map axes, with its cell at the window's lower left place.
struct Placed {
  int column, row;
  double gx, gy;
};

std::vector<Placed> placed(const TerrainTemplate& terrain, const Lattice& lattice, const Placement& corner) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(corner.yaw_rad).toRotationMatrix();
  std::vector<Placed> out;
  for (const TerrainSample& sample : terrain.samples) {
    const Eigen::Vector2d p = corner.center_map + R * sample.p, g = R * sample.g;
    out.push_back({static_cast<int>(std::floor((p.x() - lattice.x0_m) / lattice.cell_m)),
                   static_cast<int>(std::floor((p.y() - lattice.y0_m) / lattice.cell_m)), g.x(), g.y()});
  }
  return out;
}

double score_at(const PlaneField& field, const std::vector<Placed>& samples, int du, int dv, double min_overlap) {
  CorrelationSums sums;
  for (const Placed& s : samples) {
    if (!field.lattice.contains(s.column + du, s.row + dv)) continue;
    const size_t i = field.lattice.index(s.column + du, s.row + dv);
    if (field.known[i] != 0) sums.add(s.gx, s.gy, field.gx[i], field.gy[i]);
  }
  return sums.count >= min_overlap * static_cast<double>(samples.size()) ? sums.correlation() : -1.0;
}

// The best turn at each place, places row by row.
std::vector<Peak> best_turns(const OrbitalPart& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                             int steps) {
  const Lattice& lattice = orbital.field().lattice;
  const int side = 2 * steps + 1;
  const int turns = static_cast<int>(std::ceil(window.reach_rad / window.yaw_step_rad));
  std::vector<Peak> best(static_cast<size_t>(side) * static_cast<size_t>(side));
  for (int turn = -turns; turn <= turns; ++turn) {
    Placement corner = window.prior;
    corner.center_map.array() -= steps * lattice.cell_m;
    corner.yaw_rad += window.reach_rad * turn / std::max(turns, 1);
    const std::vector<Placed> samples = placed(terrain, lattice, corner);
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

std::vector<Peak> find_peaks(const OrbitalPart& orbital, const TerrainTemplate& terrain, const SearchWindow& window,
                             double apart_m, int most) {
  const int steps = static_cast<int>(std::ceil(window.reach_m / orbital.field().lattice.cell_m));
  std::vector<Peak> all = best_turns(orbital, terrain, window, steps);
  std::stable_sort(all.begin(), all.end(), [](const Peak& a, const Peak& b) { return a.score > b.score; });
  std::vector<Peak> peaks;
  for (const Peak& peak : all) {
    if (peak.score <= 0.0 || static_cast<int>(peaks.size()) >= most) break;
    const bool apart = std::all_of(peaks.begin(), peaks.end(), [&](const Peak& higher) {
      return (higher.placement.center_map - peak.placement.center_map).norm() > apart_m;
    });
    if (apart) peaks.push_back(peak);
  }
  return peaks;
}

}  // namespace rover::global
