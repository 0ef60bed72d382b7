// Quantiles, and intervals of 95 % for proportions and for the mean of normalised estimation errors.
#pragma once

#include <vector>

namespace rover {

struct Interval {
  double low;
  double high;
};

// Score interval of a proportion (Wilson 1927); NaN without trials. Trials may be an effective number.
Interval wilson(double successes, double trials);

// Of sorted values, interpolated between neighbours; NaN without values.
double quantile(const std::vector<double>& sorted, double ratio);

// Bounds of the mean of chi-square values divided by their degrees of freedom, which a consistent filter keeps in 95 %
// of all cases (Bar-Shalom, Li and Kirubarajan 2001, ch. 5.4). `degrees_of_freedom`: of all independent values
// together, e.g. 3 times the number of runs for x, y and yaw.
Interval mean_nees_bounds(double degrees_of_freedom);

}  // namespace rover
