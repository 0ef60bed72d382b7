#include "tools/campaign/page/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common/core/frames.hpp"
#include "tools/report/bench_table.hpp"

namespace rover::campaign {
namespace {

std::string text_of(const Row& row, const std::string& key) {
  const auto it = row.texts.find(key);
  return it == row.texts.end() ? "" : it->second;
}

bool died(const Row& row) {
  return row.status == "died";
}

std::string cause_name(const Row& row) {
  if (died(row)) {
    const std::string reason = text_of(row, "reason");
    return reason.empty() ? "died" : "died: " + reason;
  }
  const std::string fault = row.outcome == "fault_stop" ? text_of(row, "fault") : "";
  return fault.empty() ? row.outcome : row.outcome + ": " + fault;
}

bool failed(const Row& row) {
  if (died(row) || figure_of(row, "collisions") > 0.0) return true;
  return !reached_goal(row) && !is_infeasible(row);
}

bool is_worse(const Row* a, const Row* b) {
  const auto key = [](const Row& row) {
    const double contacts = figure_of(row, "collisions");
    const double progress = figure_of(row, "progress");
    return std::make_tuple(std::isfinite(contacts) ? -contacts : 0.0, std::isfinite(progress) ? progress : kInfinity,
                           row.cell, row.seed);
  };
  return key(*a) < key(*b);
}

}  // namespace

std::vector<std::string> page_columns() {
  std::vector<std::string> columns = {"collisions",       "oracle_feasible", "progress", "driven_length_m",
                                      "planned_length_m", "duration_s",      "fault",    "reason"};
  for (const ShownFigure& figure : kShownFigures)
    if (std::find(columns.begin(), columns.end(), figure.key) == columns.end()) columns.emplace_back(figure.key);
  for (const ShownFigure& figure : kTableFigures) columns.emplace_back(figure.key);
  return columns;
}

double figure_of(const Row& row, const std::string& figure) {
  const auto it = row.figures.find(figure);
  return it == row.figures.end() ? kNaN : it->second;
}

bool reached_goal(const Row& row) {
  return row.outcome == "goal_reached" && !(figure_of(row, "collisions") > 0.0);
}

bool is_infeasible(const Row& row) {
  return figure_of(row, "oracle_feasible") == 0.0;
}

SuccessCount count(const Drives& drives) {
  SuccessCount out;
  for (const Row* row : drives) {
    const bool feasible = !is_infeasible(*row);
    const double contacts = figure_of(*row, "collisions");
    ++out.drives;
    ++(feasible ? out.feasible : out.infeasible);
    if (reached_goal(*row)) ++(feasible ? out.reached : out.reached_infeasible);
    out.without_oracle += std::isfinite(figure_of(*row, "oracle_feasible")) ? 0 : 1;
    out.died += died(*row) ? 1 : 0;
    out.contacts += std::isfinite(contacts) ? contacts : 0.0;
    out.unknown_contacts += std::isfinite(contacts) || died(*row) ? 0 : 1;
  }
  return out;
}

double shown_value(const Row& row, const ShownFigure& figure) {
  if (is_infeasible(row) || (figure.reached_only && !reached_goal(row))) return kNaN;
  return figure_of(row, figure.key);
}

Spread spread(const Drives& drives, const ShownFigure& figure) {
  std::vector<double> values;
  for (const Row* row : drives)
    if (const double value = shown_value(*row, figure); std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {0, kNaN, kNaN};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {static_cast<int>(values.size()), report::median(values), figure.higher_is_better ? *low : *high};
}

std::vector<Cause> causes(const Drives& drives) {
  std::map<std::string, Drives> by_name;
  for (const Row* row : drives)
    if (failed(*row)) by_name[cause_name(*row)].push_back(row);
  std::vector<Cause> out;
  for (auto& [name, of_cause] : by_name) {
    std::sort(of_cause.begin(), of_cause.end(), is_worse);
    out.push_back({name, of_cause});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Cause& a, const Cause& b) { return a.drives.size() > b.drives.size(); });
  return out;
}

std::string counted(double number, const std::string& what) {
  return fmt::format("{:.0f} {}{}", number, what, number == 1.0 ? "" : "s");
}

Drives pointers(const std::vector<Row>& rows) {
  Drives out;
  for (const Row& row : rows) out.push_back(&row);
  return out;
}

std::map<Cell, Drives> by_cell(const Drives& drives) {
  std::map<Cell, Drives> out;
  for (const Row* row : drives) out[row->cell].push_back(row);
  return out;
}

}  // namespace rover::campaign
