// The comparison of two campaigns in words: lines of its tables, the same on the page and in Markdown.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/page/comparison.hpp"

namespace rover::campaign {

using Line = std::vector<std::string>;

struct Table {
  size_t texts = 1;  // columns that are no numbers
  Line head;
  std::vector<Line> lines;
};

// B - A of a figure: the median of the differences, of counts (which have few values) their mean.
struct Difference {
  double value;
  Interval interval;
  int decimals;
};
Difference difference_of(const FigureComparison& comparison, const ShownFigure& figure);

// "+0.12", no sign at zero; "n/a" if unknown.
std::string signed_text(double value, int decimals);
std::string interval_text(const Interval& interval, int decimals);
std::string p_text(double p);

Table overall_table(const Comparison& comparison);
// How many cells differ in each figure, for better or worse.
Table found_table(const Comparison& comparison);
// The cells that differ in success, or in a figure, the surest first.
Table success_cells(const Comparison& comparison, const Cell& common);
Table figure_cells(const Comparison& comparison, size_t figure, const Cell& common);

std::string pairs_text(const Comparison& comparison);
std::string method_text();
std::string family_text(const Comparison& comparison);

}  // namespace rover::campaign
