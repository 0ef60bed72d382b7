#include "tools/report/bench_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/core/statistics.hpp"
#include "tools/report/time_account.hpp"

namespace rover::report {

std::string decimal(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "n/a";
}

std::vector<double> values(const BenchRows& rows, const RowFigure& figure) {
  std::vector<double> out;
  for (const BenchRow& row : rows) out.push_back(figure(row));
  return out;
}

double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

Gate all_gate(const BenchRows& rows, const std::string& requirement, int decimals, const RowFigure& figure,
              const std::function<bool(const BenchRow&, double)>& met) {
  Gate gate{requirement, "", !rows.empty()};
  double worst = -kInfinity;
  int failed = 0;
  for (const BenchRow& row : rows) {
    const double value = figure(row);
    const bool good = std::isfinite(value) && met(row, value);
    failed += good ? 0 : 1;
    if (std::isfinite(value)) worst = std::max(worst, value);
  }
  gate.met = gate.met && failed == 0;
  gate.measured = fmt::format("maximum {}{}", decimal(worst, decimals),
                              failed > 0 ? fmt::format(", {} of {} runs fail", failed, rows.size()) : "");
  return gate;
}

std::string gates_table(const std::vector<Gate>& gates) {
  std::string out = "| requirement | measured | met |\n|---|---|---|\n";
  for (const Gate& gate : gates)
    out += fmt::format("| {} | {} | {} |\n", gate.requirement, gate.measured, gate.met ? "yes" : "**no**");
  return out;
}

std::string runs_head(const std::vector<BenchColumn>& columns) {
  std::string titles = "| scenario | seed | outcome |";
  std::string rule = "|---|---|---|";
  for (const BenchColumn& column : columns) {
    titles += fmt::format(" {} |", column.title);
    rule += "---|";
  }
  return titles + " time by cause [%] | deterministic |\n" + rule + "---|---|\n";
}

std::string run_line(const BenchRow& row, const std::vector<BenchColumn>& columns) {
  std::string out = fmt::format("| {} | {} | {} |", row.scenario, row.seed, row.outcome);
  for (const BenchColumn& column : columns) out += fmt::format(" {} |", decimal(column.figure(row), column.decimals));
  return out + fmt::format(" {} | {} |\n", time_by_cause({row}), row.deterministic ? "yes" : "no");
}

std::string median_line(const std::string& what, const BenchRows& rows, const std::vector<BenchColumn>& columns) {
  std::string out = fmt::format("| **{}** | **median of {}** | |", what, rows.size());
  for (const BenchColumn& column : columns)
    out += fmt::format(" {} |", decimal(median(values(rows, column.figure)), column.decimals));
  return out + fmt::format(" all: {} | |\n", time_by_cause(rows));
}

std::string time_by_cause(const BenchRows& rows) {
  std::map<std::string, double> spent;
  double total_s = 0.0;
  for (const BenchRow& row : rows)
    for (const auto& [cause, seconds] : row.seconds) {
      spent[cause] += seconds;
      total_s += seconds;
    }
  if (!(total_s > 0.0)) return "n/a";
  std::string out;
  for (int i = 0; i < kTimeCauses; ++i) {
    const char* key = key_of(static_cast<TimeCause>(i));
    const double percent = 100.0 * spent[key] / total_s;
    if (percent < 0.05) continue;
    std::string name = key;
    std::replace(name.begin(), name.end(), '_', ' ');
    out += fmt::format("{}{} {:.1f}", out.empty() ? "" : ", ", name, percent);
  }
  return out;
}

std::string consistency_line(const BenchRows& rows) {
  if (rows.empty()) return "ANEES of POSE: n/a.";
  const auto mean = [&](const RowFigure& figure) {
    double sum = 0.0;
    for (const double value : values(rows, figure)) sum += value;
    return decimal(sum / static_cast<double>(rows.size()), 2);
  };
  std::set<std::int64_t> starts;  // drives of one seed have the same error of the start pose
  for (const BenchRow& row : rows) starts.insert(row.seed);
  const Interval single = mean_nees_bounds(static_cast<double>(starts.size()));
  const Interval together = mean_nees_bounds(3.0 * static_cast<double>(starts.size()));
  return fmt::format(
      "ANEES of POSE, mean of {} drives with {} start poses: x {}, y {}, yaw {} (consistent: {:.2f} to {:.2f}); "
      "together {} ({:.2f} to {:.2f}). More is overconfident.",
      rows.size(), starts.size(), mean(&BenchRow::anees_x), mean(&BenchRow::anees_y), mean(&BenchRow::anees_yaw),
      single.low, single.high, mean(&BenchRow::anees_xyyaw), together.low, together.high);
}

}  // namespace rover::report
