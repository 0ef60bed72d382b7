// Known values: each is published.
#include "tools/campaign/page/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "common/core/frames.hpp"
#include "tools/report/bench_table.hpp"

namespace rover::campaign {
namespace {

void expect_interval(const Interval& interval, double low, double high, double tolerance) {
  EXPECT_NEAR(interval.low, low, tolerance);
  EXPECT_NEAR(interval.high, high, tolerance);
}

// Newcombe (1998), Statistics in Medicine 17, 2635-2650; Bentur et al. (2009) in Fagerland et al. (2017), chapter 8.
TEST(NewcombePaired, PublishedExamples) {
  expect_interval(newcombe_paired({.both = 36, .only_a = 2, .only_b = 12}), 0.0569, 0.3404, 5e-5);
  expect_interval(newcombe_paired({.both = 1, .only_a = 7, .only_b = 1, .neither = 12}), -0.507, -0.026, 5e-4);
}

// ad - bc is 296, beyond half of the 50 pairs: phi is 271 / sqrt(32 * 18 * 22 * 28) = 0.4550; without the correction
// it would be 0.4969, and the interval narrower.
TEST(NewcombePaired, CorrectionOfTheCorrelation) {
  expect_interval(newcombe_paired({.both = 20, .only_a = 2, .only_b = 12, .neither = 16}), 0.05616, 0.32921, 5e-6);
}

TEST(NewcombePaired, ExchangeOfAAndBChangesTheSign) {
  const Interval ab = newcombe_paired({.both = 9, .only_a = 3, .only_b = 5, .neither = 3});
  const Interval ba = newcombe_paired({.both = 9, .only_a = 5, .only_b = 3, .neither = 3});
  expect_interval(ba, -ab.high, -ab.low, 1e-12);
}

// Fay (2010), Exact McNemar's test and matching confidence intervals: 2 against 9 changed pairs.
TEST(McNemar, PublishedExample) {
  EXPECT_NEAR(mcnemar_exact_p({.both = 21, .only_a = 9, .only_b = 2, .neither = 12}), 0.06543, 5e-6);
}

TEST(McNemar, NoChangeAndEqualChangesAreChance) {
  EXPECT_EQ(mcnemar_exact_p({.both = 20}), 1.0);
  EXPECT_EQ(mcnemar_exact_p({.only_a = 4, .only_b = 4}), 1.0);
}

// Hollander and Wolfe (1973), depression scores of nine patients: rank sum 40, p 0.039.
TEST(SignedRank, PublishedExample) {
  const double before[] = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const double after[] = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> differences;
  for (size_t i = 0; i < 9; ++i) differences.push_back(after[i] - before[i]);
  EXPECT_NEAR(signed_rank_p(differences), 0.03906, 5e-6);
}

TEST(SignedRank, TiesAndZeros) {
  EXPECT_EQ(signed_rank_p({0.0, 0.0}), 1.0);
  // Zeros are left out: 2 of 2^5 sign patterns are as extreme as five equal differences.
  EXPECT_NEAR(signed_rank_p({1.0, 1.0, 0.0, 1.0, 1.0, 1.0}), 2.0 / 32.0, 1e-12);
}

TEST(SignedRank, ExactAndNormalAgreeAtTheirBorder) {
  std::vector<double> differences;
  for (int i = 1; i <= 60; ++i) differences.push_back(i % 3 == 0 ? -i : i);
  const double exact = signed_rank_p(differences);
  differences.push_back(0.001);  // the lowest rank
  EXPECT_NEAR(signed_rank_p(differences), exact, 0.1 * exact);
}

// Benjamini and Hochberg (1995), section 3.2: of 15 p values the first four are rejected at 5 %.
TEST(BenjaminiHochberg, PublishedExample) {
  const std::vector<double> p = {0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                                 0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
  const std::vector<double> adjusted = benjamini_hochberg(p);
  for (size_t i = 0; i < p.size(); ++i) EXPECT_EQ(adjusted[i] <= 0.05, i < 4) << i;
  EXPECT_NEAR(adjusted[3], 0.0095 * 15 / 4, 1e-12);
}

TEST(BenjaminiHochberg, AnyOrderAndUnknown) {
  const std::vector<double> adjusted = benjamini_hochberg({0.04, kNaN, 0.01});
  EXPECT_NEAR(adjusted[0], 0.04, 1e-12);
  EXPECT_TRUE(std::isnan(adjusted[1]));
  EXPECT_NEAR(adjusted[2], 0.02, 1e-12);
}

// The interval is that of theory, 1.96 standard errors, within its own noise.
TEST(Bootstrap, IntervalOfTheMeanAgreesWithTheory) {
  std::vector<SeedValue> values;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double v = std::sin(12.9898 * i) * 3.0;
    values.push_back({i, v});
    sum += v;
    squares += v * v;
  }
  const double centre = sum / 400;
  const double half = 1.96 * std::sqrt((squares / 400 - centre * centre) / 400);
  expect_interval(bootstrap_mean(values), centre - half, centre + half, 0.1 * half);
}

// The same draws, sample by sample.
TEST(Bootstrap, MedianAndMeanAreThoseOfTheResamples) {
  std::map<int, std::vector<double>> of_seed;
  std::vector<SeedValue> values;
  for (int i = 0; i < 40; ++i) {
    of_seed[i % 7].push_back(std::cos(3.7 * i));
    values.push_back({i % 7, std::cos(3.7 * i)});
  }
  std::mt19937_64 random(28);
  std::vector<double> medians;
  std::vector<double> means;
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> sample;
    for (int k = 0; k < 7; ++k) {
      const std::vector<double>& group = of_seed[static_cast<int>(random() % 7)];
      sample.insert(sample.end(), group.begin(), group.end());
    }
    medians.push_back(report::median(sample));
    means.push_back(mean(sample));
  }
  std::sort(medians.begin(), medians.end());
  std::sort(means.begin(), means.end());
  // 2.5 % of 2000 samples: between the 50th and the 51st.
  const Interval median = bootstrap_median(values);
  EXPECT_GE(median.low, medians[49] - 1e-12);
  EXPECT_LE(median.low, medians[50] + 1e-12);
  const Interval of_mean = bootstrap_mean(values);
  EXPECT_GE(of_mean.high, means[1948] - 1e-12);
  EXPECT_LE(of_mean.high, means[1950] + 1e-12);
}

// The same value in ten cells of a seed is one observation: the interval does not shrink.
TEST(Bootstrap, CellsOfOneSeedAreNotIndependent) {
  std::vector<SeedValue> once;
  std::vector<SeedValue> ten_times;
  for (int seed = 1; seed <= 20; ++seed) {
    once.push_back({seed, std::cos(7.1 * seed)});
    for (int cell = 0; cell < 10; ++cell) ten_times.push_back(once.back());
  }
  const Interval a = bootstrap_median(once);
  expect_interval(bootstrap_median(ten_times), a.low, a.high, 1e-12);
  EXPECT_GT(a.high - a.low, 0.2);
}

TEST(Bootstrap, SameAtEachCallAndUnknownForFewSeeds) {
  const std::vector<SeedValue> values = {{1, 0.1}, {2, 0.4}, {3, -0.2}, {4, 0.3}, {5, 0.9}};
  EXPECT_EQ(bootstrap_mean(values).low, bootstrap_mean(values).low);
  EXPECT_TRUE(std::isnan(bootstrap_median({{1, 0.1}, {1, 0.2}, {2, 0.3}, {3, 0.3}, {4, 0.1}}).low));
}

}  // namespace
}  // namespace rover::campaign
