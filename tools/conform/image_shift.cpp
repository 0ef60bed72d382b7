#include "tools/conform/image_shift.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rover::conform {
namespace {

constexpr int kHalf = 15;           // half patch size
constexpr int kRows = 6;            // row search range, for unrectified images
constexpr int kGrid = 4;            // patches along and across
constexpr double kFound = 0.6;      // minimum correlation
constexpr size_t kMinPatches = 4;   // minimum number of matched patches, of 16
constexpr double kContrast2 = 9.0;  // minimum variance [grey^2]

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

Moments moments(const GrayImage& image, int u, int v) {
  double sum = 0.0;
  double sum2 = 0.0;
  for (int y = v - kHalf; y <= v + kHalf; ++y)
    for (int x = u - kHalf; x <= u + kHalf; ++x) {
      const double grey = image.at(x, y);
      sum += grey;
      sum2 += grey * grey;
    }
  constexpr double n = (2.0 * kHalf + 1.0) * (2.0 * kHalf + 1.0);
  return {sum / n, sum2 / n - sum * sum / (n * n)};
}

double correlation(const GrayImage& left, const Moments& of_left, int u, int v, const GrayImage& right, int ur,
                   int vr) {
  const Moments of_right = moments(right, ur, vr);
  if (of_right.variance < kContrast2) return 0.0;
  double sum = 0.0;
  for (int y = -kHalf; y <= kHalf; ++y)
    for (int x = -kHalf; x <= kHalf; ++x) sum += static_cast<double>(left.at(u + x, v + y)) * right.at(ur + x, vr + y);
  constexpr double n = (2.0 * kHalf + 1.0) * (2.0 * kHalf + 1.0);
  return (sum / n - of_left.mean * of_right.mean) / std::sqrt(of_left.variance * of_right.variance);
}

std::optional<double> shift_of(const GrayImage& left, const GrayImage& right, int reach, int u, int v) {
  const Moments of_left = moments(left, u, v);
  if (of_left.variance < kContrast2) return {};
  double best = kFound;
  std::optional<double> shift;
  for (int d = -reach; d <= reach; ++d)
    for (int dv = -kRows; dv <= kRows; dv += 2) {
      const double score = correlation(left, of_left, u, v, right, u - d, v + dv);
      if (score <= best) continue;
      best = score;
      shift = d;
    }
  return shift;
}

}  // namespace

std::optional<double> shift_to_left_px(const GrayImage& left, const GrayImage& right, int reach) {
  const int du = kHalf + reach;
  const int dv = kHalf + kRows;
  if (left.width != right.width || left.height != right.height || left.width < 2 * du + kGrid ||
      left.height < 2 * dv + kGrid)
    return {};
  std::vector<double> shifts;
  for (int row = 0; row < kGrid; ++row)
    for (int column = 0; column < kGrid; ++column) {
      const int u = du + (left.width - 1 - 2 * du) * column / (kGrid - 1);
      const int v = dv + (left.height - 1 - 2 * dv) * row / (kGrid - 1);
      if (const auto shift = shift_of(left, right, reach, u, v)) shifts.push_back(*shift);
    }
  if (shifts.size() < kMinPatches) return {};
  std::nth_element(shifts.begin(), shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() / 2), shifts.end());
  return shifts[shifts.size() / 2];
}

}  // namespace rover::conform
