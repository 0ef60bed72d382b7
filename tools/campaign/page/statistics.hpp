// Statistics of drives: proportions, paired differences, many comparisons. Intervals are of 95 %.
#pragma once

#include <cstdint>
#include <vector>

#include "common/core/statistics.hpp"

namespace rover::campaign {

// Outcomes of the same drives by A and by B.
struct PairedCounts {
  int both = 0;
  int only_a = 0;
  int only_b = 0;
  int neither = 0;
  int pairs() const { return both + only_a + only_b + neither; }
};

// Success of B minus success of A: method 10 of Newcombe (1998), Statistics in Medicine 17, 2635-2650.
Interval newcombe_paired(const PairedCounts& counts);
// Exact two-sided p value of McNemar's test.
double mcnemar_exact_p(const PairedCounts& counts);

// Two-sided p value of Wilcoxon's signed-rank test, zeros left out: exact up to 60 differences, else normal.
double signed_rank_p(std::vector<double> differences);

// Adjusted p values of Benjamini and Hochberg (1995), in the order given; NaN stays NaN and does not count as a test.
std::vector<double> benjamini_hochberg(const std::vector<double>& p_values);

double mean(const std::vector<double>& values);

// Drives of one seed may share their rocks, so a resample takes or leaves all values of a seed together.
struct SeedValue {
  std::int64_t seed;
  double value;
};
// Percentile bootstrap over seeds, the same at each call; NaN for fewer than 5 seeds.
Interval bootstrap_mean(const std::vector<SeedValue>& values);
Interval bootstrap_median(const std::vector<SeedValue>& values);

}  // namespace rover::campaign
