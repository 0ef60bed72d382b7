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
                                        const CandidatePose& corner, int max_samples) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(corner.yaw_rad).toRotationMatrix();
  const Eigen::Matrix2d turn = turn_of(terrain.layer, corner.yaw_rad).toRotationMatrix();
  const size_t stride = max_samples > 0 ? 1 + terrain.samples.size() / static_cast<size_t>(max_samples) : 1;
  std::vector<PlacedSample> out;
  for (size_t i = 0; i < terrain.samples.size(); i += stride) {
    const TerrainSample& sample = terrain.samples[i];
    const Eigen::Vector2d p = corner.center_map + R * sample.p, g = turn * sample.g;
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

// The sums of one row of the window over a map without unknown cells, one entry for each column shift, so that the
// compiler vectorises over them.
class RowSums {
 public:
  explicit RowSums(int side) : mx_(side), my_(side), mm_(side), tm_(side) {}

  void add(const PlaneField& field, const PlacedSample& s, int row) {
    const size_t start = field.lattice.index(s.column, row);
    const auto tx = static_cast<float>(s.gx), ty = static_cast<float>(s.gy);
    for (size_t i = 0; i < mx_.size(); ++i) {
      const float x = field.gx[start + i], y = field.gy[start + i];
      mx_[i] += x;
      my_[i] += y;
      mm_[i] += x * x + y * y;
      tm_[i] += tx * x + ty * y;
    }
    of_template_.add(s.gx, s.gy, 0.0, 0.0);
  }
  double correlation(int du) const {
    const auto i = static_cast<size_t>(du);
    CorrelationSums sums = of_template_;
    sums.mx = mx_[i], sums.my = my_[i], sums.mm = mm_[i], sums.tm = tm_[i];
    return sums.correlation();
  }

 private:
  std::vector<float> mx_, my_, mm_, tm_;
  CorrelationSums of_template_;
};

// Whether the field is known around all samples at every shift.
bool all_known(const PlaneField& field, const std::vector<PlacedSample>& samples, int side) {
  if (samples.empty()) return false;
  const auto by_column = [](const PlacedSample& a, const PlacedSample& b) { return a.column < b.column; };
  const auto by_row = [](const PlacedSample& a, const PlacedSample& b) { return a.row < b.row; };
  const auto [west, east] = std::minmax_element(samples.begin(), samples.end(), by_column);
  const auto [south, north] = std::minmax_element(samples.begin(), samples.end(), by_row);
  const int end_column = east->column + side, end_row = north->row + side;
  if (!field.lattice.contains(west->column, south->row) || !field.lattice.contains(end_column - 1, end_row - 1))
    return false;
  for (int row = south->row; row < end_row; ++row)
    for (int column = west->column; column < end_column; ++column)
      if (field.known[field.lattice.index(column, row)] == 0) return false;
  return true;
}

// Scores of one row of the window. `whole`: no sample is on an unknown cell at any shift.
std::vector<double> row_scores(const PlaneField& field, const std::vector<PlacedSample>& samples, int dv, int side,
                               bool whole, double min_overlap) {
  std::vector<double> scores;
  if (!whole) {
    for (int du = 0; du < side; ++du) scores.push_back(score_at(field, samples, du, dv, min_overlap));
    return scores;
  }
  RowSums sums(side);
  for (const PlacedSample& s : samples) sums.add(field, s, s.row + dv);
  for (int du = 0; du < side; ++du) scores.push_back(sums.correlation(du));
  return scores;
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
    const std::vector<PlacedSample> samples = place_samples(terrain, lattice, corner, window.max_samples);
    const bool whole = all_known(orbital.field(), samples, side);
    for (int dv = 0; dv < side; ++dv) {
      const std::vector<double> scores = row_scores(orbital.field(), samples, dv, side, whole, window.min_overlap);
      for (int du = 0; du < side; ++du) {
        Peak& peak = best[static_cast<size_t>(dv) * static_cast<size_t>(side) + static_cast<size_t>(du)];
        const double score = scores[static_cast<size_t>(du)];
        if (score <= peak.score) continue;
        peak = {{corner.center_map + lattice.cell_m * Eigen::Vector2d(du, dv), corner.yaw_rad}, score};
      }
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
