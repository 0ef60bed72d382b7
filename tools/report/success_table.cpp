#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/core/statistics.hpp"
#include "tools/report/bench_figures.hpp"

namespace rover::report {
namespace {

const std::vector<BenchColumn>& success_columns() {
  static const std::vector<BenchColumn> kColumns = {
      {"planned [m]", 1, &BenchRow::planned_length_m},
      {"driven [m]", 1, &BenchRow::driven_length_m},
      {"ratio", 3, &BenchRow::path_ratio},
      {"oracle [m]", 1, &BenchRow::oracle_m},
      {"regret", 3, &BenchRow::regret},
      {"progress", 3, &BenchRow::progress},
      {"duty", 3, &BenchRow::duty},
      {"time [s]", 0, &BenchRow::duration_s},
      {"repairs", 0, &BenchRow::replans},
      {"hazard stops", 0, &BenchRow::hazard_stops},
      {"false stops", 0, &BenchRow::false_stops},
      {"collisions", 0, &BenchRow::collisions},
      {"rocks missed", 0, &BenchRow::rocks_missed},
      {"in reverse [m]", 1, &BenchRow::reverse_m},
      {"closest wheel to a hazard [m]", 2, &BenchRow::hazard_clearance_m}};
  return kColumns;
}

bool reached(const BenchRow& row) {
  return row.outcome == "goal_reached";
}

BenchRows rows_where(const BenchRows& rows, const std::function<bool(const BenchRow&)>& condition) {
  BenchRows out;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(out), condition);
  return out;
}

// "36 of 40 (90 %; 77 to 96 %)": with Wilson's interval of 95 %.
std::string success_text(const BenchRows& rows) {
  if (rows.empty()) return "n/a";
  const auto n = static_cast<double>(rows.size());
  const auto good = static_cast<double>(std::count_if(rows.begin(), rows.end(), reached));
  const Interval interval = wilson(good, n);
  return fmt::format("{:.0f} of {:.0f} ({:.0f} %; {:.0f} to {:.0f} %)", good, n, 100.0 * good / n, 100.0 * interval.low,
                     100.0 * interval.high);
}

enum class Worst { kLargest, kSmallest };

std::string median_and_worst(const BenchRows& rows, const RowFigure& figure, int decimals, Worst kind) {
  std::vector<double> known = values(rows, figure);
  std::erase_if(known, [](double v) { return !std::isfinite(v); });
  if (known.empty()) return "n/a";
  const auto [smallest, largest] = std::minmax_element(known.begin(), known.end());
  return decimal(median(known), decimals) + "; " + decimal(kind == Worst::kLargest ? *largest : *smallest, decimals);
}

// "3", or "3 (1 unknown)" if a row lacks the figure.
std::string sum_text(const BenchRows& rows, const RowFigure& figure) {
  double sum = 0.0;
  int unknown = 0;
  for (const double value : values(rows, figure)) {
    sum += std::isfinite(value) ? value : 0.0;
    unknown += std::isfinite(value) ? 0 : 1;
  }
  return decimal(sum, 0) + (unknown > 0 ? fmt::format(" ({} unknown)", unknown) : "");
}

// Driven lengths of drives that gave up early flatter: ratio and regret of those that reached the goal.
std::string level_summary(const BenchRows& rows) {
  const BenchRows good = rows_where(rows, reached);
  const BenchRows judged = rows_where(rows, [](const BenchRow& row) { return row.oracle_feasible.has_value(); });
  const BenchRows feasible = rows_where(judged, [](const BenchRow& row) { return *row.oracle_feasible; });
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", rows.front().level, success_text(rows),
      judged.empty() ? "n/a" : fmt::format("{} of {}", feasible.size(), judged.size()), success_text(feasible),
      median_and_worst(good, &BenchRow::path_ratio, 3, Worst::kLargest),
      median_and_worst(good, &BenchRow::regret, 3, Worst::kLargest),
      median_and_worst(rows, &BenchRow::progress, 3, Worst::kSmallest),
      median_and_worst(rows, &BenchRow::duty, 3, Worst::kSmallest),
      median_and_worst(rows, &BenchRow::hazard_stops, 0, Worst::kLargest), sum_text(rows, &BenchRow::false_stops),
      sum_text(rows, &BenchRow::collisions), sum_text(rows, &BenchRow::rocks_missed));
}

constexpr char kSummaryHead[] =
    "| level | goals reached (95 % interval) | drivable by the oracle | goals reached of these | ratio | regret | "
    "progress | duty | hazard stops | false stops, total | collisions | rocks missed |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|---|\n";

std::string failures_text(const BenchRows& rows) {
  std::map<std::string, std::string> seeds_of;
  for (const BenchRow& row : rows)
    if (!reached(row))
      seeds_of[row.outcome] += fmt::format("{}{}", seeds_of[row.outcome].empty() ? "" : ", ", row.seed);
  std::string out;
  for (const auto& [outcome, seeds] : seeds_of)
    out += fmt::format("{}{} (seeds {})", out.empty() ? "" : "; ", outcome, seeds);
  return out.empty() ? "none" : out;
}

std::string level_section(const BenchRows& rows) {
  std::string out = fmt::format(
      "\n## Level `{}`\n\n- commit: `{}`\n- command: `{}`\n- failures: {}\n- time by cause [%]: {}\n- {}\n\n",
      rows.front().level, rows.front().commit, rows.back().command, failures_text(rows), time_by_cause(rows),
      consistency_line(rows));
  out += runs_head(success_columns());
  for (const BenchRow& row : rows) out += run_line(row, success_columns());
  return out + median_line(rows.front().scenario, rows, success_columns());
}

std::vector<BenchRows> by_level(const BenchRows& rows) {
  std::vector<BenchRows> levels;
  for (const char* level : {"efficient", "auto", "full"}) {
    const BenchRows of_level = rows_where(rows, [&](const BenchRow& row) { return row.level == level; });
    if (!of_level.empty()) levels.push_back(of_level);
  }
  return levels;
}

}  // namespace

std::vector<Gate> success_gates(const std::vector<BenchRow>& rows) {
  const auto none = [](const BenchRow&, double value) { return value == 0.0; };
  std::vector<Gate> gates;
  for (const BenchRows& level : by_level(rows)) {
    const std::string name = level.front().level;
    gates.push_back(all_gate(level, name + ": 0 collisions", 0, &BenchRow::collisions, none));
    gates.push_back(all_gate(level, name + ": 0 rocks missed", 0, &BenchRow::rocks_missed, none));
  }
  return gates;
}

std::string success_table(const BenchContext& context, const std::vector<BenchRow>& rows) {
  std::string out = fmt::format("# Bench `{}`\n\nMachine: {}, {} cores.\n\n{}", context.suite, context.cpu_model,
                                context.cores, kSummaryHead);
  const std::vector<BenchRows> levels = by_level(rows);
  for (const BenchRows& level : levels) out += level_summary(level);
  out +=
      "\nMedian; worst. Ratio (driven / planned) and regret (driven / oracle) are of the drives that reached the goal, "
      "the other columns of all. Progress: planned length, or its part made good, over top speed x time.\n\n";
  out += gates_table(success_gates(rows));
  for (const BenchRows& level : levels) out += level_section(level);
  return out;
}

}  // namespace rover::report
