#include "tools/campaign/page/comparison.hpp"

#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "common/core/frames.hpp"
#include "tools/report/bench_table.hpp"

namespace rover::campaign {
namespace {

using Pairs = std::vector<DrivePair>;
using PairKey = std::pair<Cell, std::int64_t>;

// Axes with the same value in each row.
Cell constant_axes(const std::vector<Row>& rows) {
  Cell out = rows.empty() ? Cell() : rows.front().cell;
  for (const Row& row : rows)
    std::erase_if(out, [&](const auto& entry) {
      const auto it = row.cell.find(entry.first);
      return it == row.cell.end() || it->second != entry.second;
    });
  return out;
}

bool has_axis(const std::vector<Row>& rows, const std::string& axis) {
  for (const Row& row : rows)
    if (row.cell.contains(axis)) return true;
  return false;
}

// Constant axes of one campaign that the other one lacks, or has another constant value of.
Cell own_axes(const std::vector<Row>& rows, const std::vector<Row>& others) {
  Cell out = constant_axes(rows);
  const Cell constant = constant_axes(others);
  std::erase_if(out, [&](const auto& entry) {
    const auto it = constant.find(entry.first);
    return it != constant.end() ? it->second == entry.second : has_axis(others, entry.first);
  });
  return out;
}

std::map<PairKey, const Row*> by_key(const std::vector<Row>& rows, const Cell& without) {
  std::map<PairKey, const Row*> out;
  for (const Row& row : rows) {
    Cell cell = row.cell;
    for (const auto& [axis, value] : without) cell.erase(axis);
    out[{cell, row.seed}] = &row;
  }
  return out;
}

SuccessComparison compare_success(const Pairs& pairs) {
  SuccessComparison out{};
  PairedCounts& c = out.counts;
  for (const DrivePair& pair : pairs) {
    if (is_infeasible(*pair.a) || is_infeasible(*pair.b)) continue;
    const bool a = reached_goal(*pair.a);
    const bool b = reached_goal(*pair.b);
    ++(a && b ? c.both : a ? c.only_a : b ? c.only_b : c.neither);
  }
  out.difference = c.pairs() == 0 ? kNaN : static_cast<double>(c.only_b - c.only_a) / c.pairs();
  out.interval = newcombe_paired(c);
  out.p = c.pairs() == 0 ? kNaN : mcnemar_exact_p(c);
  out.q = kNaN;
  return out;
}

FigureComparison compare_figure(const Pairs& pairs, const ShownFigure& figure) {
  std::vector<double> of_a;
  std::vector<double> of_b;
  std::vector<double> differences;
  std::vector<SeedValue> by_seed;
  for (const DrivePair& pair : pairs) {
    const double a = shown_value(*pair.a, figure);
    const double b = shown_value(*pair.b, figure);
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    of_a.push_back(a);
    of_b.push_back(b);
    differences.push_back(b - a);
    by_seed.push_back({pair.a->seed, b - a});
  }
  return {static_cast<int>(differences.size()),
          report::median(of_a),
          report::median(of_b),
          report::median(differences),
          bootstrap_median(by_seed),
          mean(differences),
          bootstrap_mean(by_seed),
          differences.empty() ? kNaN : signed_rank_p(differences),
          kNaN};
}

PairsComparison compare_pairs(const Pairs& pairs) {
  PairsComparison out{compare_success(pairs), {}};
  for (const ShownFigure& figure : kShownFigures) out.figures.push_back(compare_figure(pairs, figure));
  return out;
}

Interval success_by_seed(const Pairs& pairs) {
  std::vector<SeedValue> values;
  for (const DrivePair& pair : pairs)
    if (!is_infeasible(*pair.a) && !is_infeasible(*pair.b))
      values.push_back({pair.a->seed, static_cast<double>(reached_goal(*pair.b)) - reached_goal(*pair.a)});
  return bootstrap_mean(values);
}

// One family: all tests of all cells.
void adjust(Comparison& out) {
  std::vector<double> p;
  for (const CellComparison& cell : out.cells) {
    p.push_back(cell.pairs.success.p);
    for (const FigureComparison& figure : cell.pairs.figures) p.push_back(figure.p);
  }
  const std::vector<double> q = benjamini_hochberg(p);
  size_t i = 0;
  for (CellComparison& cell : out.cells) {
    cell.pairs.success.q = q[i++];
    for (FigureComparison& figure : cell.pairs.figures) figure.q = q[i++];
  }
  for (const double value : q) out.tests += std::isfinite(value) ? 1 : 0;
}

void count_pair(const DrivePair& pair, Comparison& out) {
  const auto contacts = [](const Row& row) {
    const double n = figure_of(row, "collisions");
    return std::isfinite(n) ? n : 0.0;
  };
  ++out.pairs;
  out.infeasible += is_infeasible(*pair.a) || is_infeasible(*pair.b) ? 1 : 0;
  out.contacts_a += contacts(*pair.a);
  out.contacts_b += contacts(*pair.b);
}

}  // namespace

Comparison compare(const std::vector<Row>& a, const std::vector<Row>& b) {
  Comparison out{};
  out.only_a = own_axes(a, b);
  out.only_b = own_axes(b, a);
  const std::map<PairKey, const Row*> of_a = by_key(a, out.only_a);
  const std::map<PairKey, const Row*> of_b = by_key(b, out.only_b);
  std::map<Cell, Pairs> cells;
  Pairs all;
  for (const auto& [key, row] : of_a) {
    const auto it = of_b.find(key);
    if (it == of_b.end()) continue;
    all.push_back({row, it->second});
    cells[key.first].push_back(all.back());
    count_pair(all.back(), out);
  }
  out.unpaired_a = static_cast<int>(of_a.size()) - out.pairs;
  out.unpaired_b = static_cast<int>(of_b.size()) - out.pairs;
  for (const auto& [cell, pairs] : cells) out.cells.push_back({cell, compare_pairs(pairs)});
  out.all = compare_pairs(all);
  out.success_by_seed = success_by_seed(all);
  adjust(out);
  return out;
}

bool differs(const SuccessComparison& success) {
  return success.q <= kFalseDiscoveryRate;
}

bool differs(const FigureComparison& figure) {
  return figure.q <= kFalseDiscoveryRate;
}

}  // namespace rover::campaign
