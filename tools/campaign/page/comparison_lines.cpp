#include "tools/campaign/page/comparison_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/page/page_html.hpp"
#include "tools/campaign/page/panels.hpp"
#include "tools/report/html_parts.hpp"

namespace rover::campaign {
namespace {

using report::shown;

constexpr double kPercent = 100.0;

Interval in_percent(const Interval& interval) {
  return {kPercent * interval.low, kPercent * interval.high};
}

Line success_line(const SuccessComparison& s, const Interval& by_seed) {
  const PairedCounts& n = s.counts;
  return {"Success of feasible drives [%]",
          std::to_string(n.pairs()),
          success_text(n.both + n.only_a, n.pairs()),
          success_text(n.both + n.only_b, n.pairs()),
          signed_text(kPercent * s.difference, 1),
          interval_text(in_percent(by_seed), 1),
          "",
          ""};
}

Line figure_line(const ShownFigure& figure, const FigureComparison& f) {
  const int digits = difference_of(f, figure).decimals;
  return {figure.title,
          std::to_string(f.pairs),
          shown(f.median_a, figure.decimals),
          shown(f.median_b, figure.decimals),
          signed_text(f.mean_difference, digits),
          interval_text(f.mean_interval, digits),
          signed_text(f.median_difference, digits),
          interval_text(f.median_interval, digits)};
}

// Lines of cells, by their q.
class SortedLines {
 public:
  void add(double q, Line line) { lines_.emplace_back(q, std::move(line)); }
  std::vector<Line> sorted() {
    std::stable_sort(lines_.begin(), lines_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Line> out;
    for (auto& [q, line] : lines_) out.push_back(std::move(line));
    return out;
  }

 private:
  std::vector<std::pair<double, Line>> lines_;
};

Line cell_head(const std::string& a, const std::string& b) {
  return {"cell", "pairs", a, b, "B - A", "95 % interval", "p", "q"};
}

}  // namespace

Difference difference_of(const FigureComparison& f, const ShownFigure& figure) {
  if (figure.decimals == 0) return {f.mean_difference, f.mean_interval, 1};
  return {f.median_difference, f.median_interval, figure.decimals + 1};
}

std::string signed_text(double value, int decimals) {
  if (!std::isfinite(value)) return "n/a";
  const double digit = std::pow(10.0, -decimals);
  if (std::abs(value) < 0.5 * digit) return fmt::format("{:.{}f}", 0.0, decimals);
  return fmt::format("{:+.{}f}", value, decimals);
}

std::string interval_text(const Interval& interval, int decimals) {
  if (!std::isfinite(interval.low)) return "n/a";
  return signed_text(interval.low, decimals) + " to " + signed_text(interval.high, decimals);
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return "";
  return p < 0.001 ? "< 0.001" : fmt::format("{:.3f}", p);
}

Table overall_table(const Comparison& c) {
  Table table{1, {"", "pairs", "A", "B", "mean of B - A", "95 % interval", "median of B - A", "95 % interval"}, {}};
  table.lines.push_back(success_line(c.all.success, c.success_by_seed));
  for (size_t i = 0; i < std::size(kShownFigures); ++i)
    table.lines.push_back(figure_line(kShownFigures[i], c.all.figures[i]));
  return table;
}

Table found_table(const Comparison& c) {
  Table table{1, {"", "cells", "differ", "B better", "B worse"}, {}};
  const auto add = [&](const std::string& title, const auto& differs_in, const auto& gain) {
    int different = 0;
    int better = 0;
    int worse = 0;
    for (const CellComparison& cell : c.cells) {
      if (!differs_in(cell.pairs)) continue;
      ++different;
      better += gain(cell.pairs) > 0.0 ? 1 : 0;
      worse += gain(cell.pairs) < 0.0 ? 1 : 0;
    }
    table.lines.push_back({title, std::to_string(c.cells.size()), std::to_string(different), std::to_string(better),
                           std::to_string(worse)});
  };
  add(
      "Success", [](const PairsComparison& pairs) { return differs(pairs.success); },
      [](const PairsComparison& pairs) { return pairs.success.difference; });
  for (size_t i = 0; i < std::size(kShownFigures); ++i)
    add(
        kShownFigures[i].title, [i](const PairsComparison& pairs) { return differs(pairs.figures[i]); },
        [i](const PairsComparison& pairs) {
          const double difference = difference_of(pairs.figures[i], kShownFigures[i]).value;
          return kShownFigures[i].higher_is_better ? difference : -difference;
        });
  return table;
}

Table success_cells(const Comparison& c, const Cell& common) {
  Table table{1, cell_head("A", "B"), {}};
  SortedLines lines;
  for (const CellComparison& cell : c.cells) {
    const SuccessComparison& s = cell.pairs.success;
    const int n = s.counts.pairs();
    if (!differs(s)) continue;
    lines.add(
        s.q,
        {cell_title(cell.cell, common), std::to_string(n), fmt::format("{}/{}", s.counts.both + s.counts.only_a, n),
         fmt::format("{}/{}", s.counts.both + s.counts.only_b, n), signed_text(kPercent * s.difference, 0) + " %",
         interval_text(in_percent(s.interval), 0) + " %", p_text(s.p), p_text(s.q)});
  }
  table.lines = lines.sorted();
  return table;
}

Table figure_cells(const Comparison& c, size_t figure, const Cell& common) {
  const ShownFigure& shown_figure = kShownFigures[figure];
  Table table{1, cell_head("A, median", "B, median"), {}};
  SortedLines lines;
  for (const CellComparison& cell : c.cells) {
    const FigureComparison& f = cell.pairs.figures[figure];
    if (!differs(f)) continue;
    const Difference d = difference_of(f, shown_figure);
    lines.add(f.q, {cell_title(cell.cell, common), std::to_string(f.pairs), shown(f.median_a, shown_figure.decimals),
                    shown(f.median_b, shown_figure.decimals), signed_text(d.value, d.decimals),
                    interval_text(d.interval, d.decimals), p_text(f.p), p_text(f.q)});
  }
  table.lines = lines.sorted();
  return table;
}

std::string pairs_text(const Comparison& c) {
  std::string out = fmt::format("{} of the same cell and seed, {} of them infeasible for the oracle",
                                counted(c.pairs, "pair"), c.infeasible);
  if (c.unpaired_a + c.unpaired_b > 0)
    out += fmt::format("; without partner: {} of A, {} of B", counted(c.unpaired_a, "drive"),
                       counted(c.unpaired_b, "drive"));
  return out;
}

std::string method_text() {
  return "A and B: success with Wilson's interval, medians of the figures. B - A is paired. Its intervals in this "
         "table "
         "resample whole seeds (bootstrap), because drives of a seed may share their rocks.";
}

std::string family_text(const Comparison& c) {
  return fmt::format(
      "Success by McNemar's exact test, with Newcombe's paired interval; figures by Wilcoxon's signed-rank test of the "
      "paired differences, B - A is their median, of counts their mean. {} in all, one for each cell and figure: q is "
      "p "
      "corrected for their number (Benjamini and Hochberg). A cell differs beyond chance if q is at most {:.2f}: at "
      "most "
      "{:.0f} % of all that are named are expected to be chance.",
      counted(c.tests, "test"), kFalseDiscoveryRate, kPercent * kFalseDiscoveryRate);
}

}  // namespace rover::campaign
