#include "common/core/distance_field.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr double kFar = 1e12;  // squared cells; no marked cell

// Lower envelope of the parabolas f(q) + (p - q)^2 along a row.
class RowTransform {
 public:
  explicit RowTransform(int width) : vertex_(width), border_(width + 1), value_(width) {}

  void apply(double* row, int width) {
    int k = -1;
    for (int q = 0; q < width; ++q) {
      if (row[q] == kFar) continue;
      value_[q] = row[q];
      double s = -kInfinity;
      while (k >= 0 && (s = crossing(q, vertex_[k])) <= border_[k]) --k;
      if (k < 0) s = -kInfinity;
      vertex_[++k] = q;
      border_[k] = s;
      border_[k + 1] = kInfinity;
    }
    if (k < 0) return;
    k = 0;
    for (int p = 0; p < width; ++p) {
      while (border_[k + 1] < p) ++k;
      const double d = p - vertex_[k];
      row[p] = d * d + value_[vertex_[k]];
    }
  }

 private:
  double crossing(int q, int v) const { return 0.5 * ((value_[q] - value_[v]) / (q - v) + static_cast<double>(q + v)); }

  std::vector<int> vertex_;
  std::vector<double> border_;
  std::vector<double> value_;
};

// Squared distance within the column, for all columns at once: down, and up again.
std::vector<double> along_columns(const std::vector<std::uint8_t>& marked, int width, int height) {
  const auto w = static_cast<size_t>(width);
  std::vector<double> field(marked.size());
  std::vector<double> steps(w, kFar);
  const auto pass = [&](int y, auto&& nearer) {
    const size_t row = w * static_cast<size_t>(y);
    for (size_t x = 0; x < w; ++x) {
      steps[x] = marked[row + x] ? 0.0 : steps[x] + 1.0;
      field[row + x] = nearer(field[row + x], steps[x]);
    }
  };
  for (int y = 0; y < height; ++y) pass(y, [](double, double down) { return down; });
  std::fill(steps.begin(), steps.end(), kFar);
  for (int y = height - 1; y >= 0; --y) pass(y, [](double down, double up) { return std::min(down, up); });
  for (double& d : field) d = d >= kFar ? kFar : d * d;
  return field;
}

}  // namespace

std::vector<double> distance_field(const std::vector<std::uint8_t>& marked, int width, int height, double cell_m) {
  std::vector<double> field = along_columns(marked, width, height);
  RowTransform transform(width);
  for (int y = 0; y < height; ++y) transform.apply(&field[static_cast<size_t>(y) * width], width);
  for (double& d : field) d = d == kFar ? kInfinity : cell_m * std::sqrt(d);
  return field;
}

}  // namespace rover
