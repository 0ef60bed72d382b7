#include "common/core/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover {

Interval wilson(double successes, double trials) {
  constexpr double kZ95 = 1.959963984540054;
  constexpr double kZ2 = kZ95 * kZ95;
  if (!(trials > 0.0)) return {kNaN, kNaN};
  const double p = successes / trials;
  const double centre = (p + kZ2 / (2.0 * trials)) / (1.0 + kZ2 / trials);
  const double half = kZ95 / (1.0 + kZ2 / trials) * std::sqrt(p * (1.0 - p) / trials + kZ2 / (4.0 * trials * trials));
  return {p == 0.0 ? 0.0 : centre - half, p == 1.0 ? 1.0 : centre + half};
}

double quantile(const std::vector<double>& sorted, double ratio) {
  if (sorted.empty()) return kNaN;
  const double at = ratio * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Interval mean_nees_bounds(double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) return {kNaN, kNaN};
  const boost::math::chi_squared chi2(degrees_of_freedom);
  return {boost::math::quantile(chi2, 0.025) / degrees_of_freedom,
          boost::math::quantile(boost::math::complement(chi2, 0.025)) / degrees_of_freedom};
}

}  // namespace rover
