// Two campaigns on the same cells and seeds, drive by drive.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/page/results.hpp"
#include "tools/campaign/page/statistics.hpp"

namespace rover::campaign {

struct DrivePair {
  const Row* a;
  const Row* b;
};

// One figure over the pairs in which it counts for both.
struct FigureComparison {
  int pairs = 0;
  double median_a;
  double median_b;
  double median_difference;  // median of B - A over the pairs
  Interval median_interval;
  double mean_difference;
  Interval mean_interval;
  double p;  // signed-rank test; NaN without pairs
  double q;  // p adjusted for all tests of the cells; NaN for all cells together
};

struct SuccessComparison {
  PairedCounts counts;  // of the pairs that are feasible for both
  double difference;    // success of B minus that of A
  Interval interval;    // Newcombe
  double p;             // McNemar
  double q;
};

struct PairsComparison {
  SuccessComparison success;
  std::vector<FigureComparison> figures;  // as kShownFigures
};

struct CellComparison {
  Cell cell;
  PairsComparison pairs;
};

struct Comparison {
  std::vector<CellComparison> cells;
  PairsComparison all;
  Interval success_by_seed;  // of the difference in success, over seeds: drives of a seed may share their rocks
  Cell only_a;               // axes that are constant in each campaign, and not the same in both
  Cell only_b;
  int pairs = 0;
  int infeasible = 0;  // pairs
  int unpaired_a = 0;
  int unpaired_b = 0;
  double contacts_a = 0.0;  // of the pairs
  double contacts_b = 0.0;
  int tests = 0;
};

inline constexpr double kFalseDiscoveryRate = 0.05;

// Cells of the result lack the axes of only_a and only_b.
Comparison compare(const std::vector<Row>& a, const std::vector<Row>& b);

bool differs(const SuccessComparison& success);
bool differs(const FigureComparison& figure);

}  // namespace rover::campaign
