#include "common/core/distance_field.hpp"

#include <cmath>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr double kFar = 1e12;  // squared cells; no marked cell

// Lower envelope of the parabolas f(q) + (p - q)^2 along one line.
class LineTransform {
 public:
  explicit LineTransform(int longest) : vertex_(longest), border_(longest + 1), value_(longest) {}

  void apply(double* line, int count, int stride) {
    for (int q = 0; q < count; ++q) value_[q] = line[static_cast<size_t>(q) * stride];
    int k = 0;
    vertex_[0] = 0;
    border_[0] = -kInfinity;
    border_[1] = kInfinity;
    for (int q = 1; q < count; ++q) {
      double s = crossing(q, vertex_[k]);
      while (s <= border_[k]) s = crossing(q, vertex_[--k]);
      vertex_[++k] = q;
      border_[k] = s;
      border_[k + 1] = kInfinity;
    }
    k = 0;
    for (int p = 0; p < count; ++p) {
      while (border_[k + 1] < p) ++k;
      const double d = p - vertex_[k];
      line[static_cast<size_t>(p) * stride] = d * d + value_[vertex_[k]];
    }
  }

 private:
  double crossing(int q, int v) const { return 0.5 * ((value_[q] - value_[v]) / (q - v) + static_cast<double>(q + v)); }

  std::vector<int> vertex_;
  std::vector<double> border_;
  std::vector<double> value_;
};

}  // namespace

std::vector<double> distance_field(const std::vector<std::uint8_t>& marked, int width, int height, double cell_m) {
  std::vector<double> field(marked.size());
  for (size_t i = 0; i < marked.size(); ++i) field[i] = marked[i] ? 0.0 : kFar;
  LineTransform transform(std::max(width, height));
  for (int y = 0; y < height; ++y) transform.apply(&field[static_cast<size_t>(y) * width], width, 1);
  for (int x = 0; x < width; ++x) transform.apply(&field[static_cast<size_t>(x)], height, width);
  for (double& d : field) d = d >= 0.5 * kFar ? kInfinity : cell_m * std::sqrt(d);
  return field;
}

}  // namespace rover
