#include "tools/report/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>
#include <tuple>

#include "tools/report/bench_figures.hpp"

namespace rover::report {
namespace {

constexpr int kRuns = 20;

struct PaperTraverse {
  const char* planned;
  const char* driven;
  const char* ratio;
  const char* repairs;
};
// Azkarate et al. 2020: two field traverses, 148.2 m planned and 176.9 m driven in total.
const std::map<std::string, PaperTraverse> kPaper = {{"seed_traverse_1", {"86.0", "", "", "6"}},
                                                     {"seed_traverse_2", {"62.2", "", "", "10"}}};

using Rows = BenchRows;

bool is_seed_traverse(const BenchRow& row) {
  return kPaper.contains(row.scenario);
}

Rows by_seed(const Rows& rows) {
  Rows sorted;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(sorted), is_seed_traverse);
  std::sort(sorted.begin(), sorted.end(), [](const BenchRow& a, const BenchRow& b) {
    return std::tie(a.scenario, a.seed) < std::tie(b.scenario, b.seed);
  });
  return sorted;
}

Gate median_gate(const Rows& rows, const std::string& requirement, int decimals, const RowFigure& figure, double most) {
  const double value = median(values(rows, figure));
  return {requirement, decimal(value, decimals), value <= most};
}

Gate min_gate(const Rows& rows, const std::string& requirement, int decimals, const RowFigure& figure, double minimum) {
  const std::vector<double> all = values(rows, figure);
  const bool met = !all.empty() && std::all_of(all.begin(), all.end(), [minimum](double v) { return v >= minimum; });
  double lowest = kInfinity;
  for (const double v : all) lowest = std::fmin(lowest, v);
  return {requirement, fmt::format("minimum {}, median {}", decimal(lowest, decimals), decimal(median(all), decimals)),
          met};
}

double sum(const Rows& rows, const RowFigure& figure) {
  double total = 0.0;
  for (const BenchRow& row : rows) total += figure(row);
  return total;
}

const std::vector<BenchColumn>& seed_columns() {
  static const std::vector<BenchColumn> kColumns = {{"planned [m]", 1, &BenchRow::planned_length_m},
                                                    {"driven [m]", 1, &BenchRow::driven_length_m},
                                                    {"ratio", 3, &BenchRow::path_ratio},
                                                    {"oracle [m]", 1, &BenchRow::oracle_m},
                                                    {"regret", 3, &BenchRow::regret},
                                                    {"progress", 3, &BenchRow::progress},
                                                    {"duty", 3, &BenchRow::duty},
                                                    {"repairs", 0, &BenchRow::replans},
                                                    {"hazard stops", 0, &BenchRow::hazard_stops},
                                                    {"false stops", 0, &BenchRow::false_stops},
                                                    {"collisions", 0, &BenchRow::collisions},
                                                    {"rocks encountered", 0, &BenchRow::rocks_encountered},
                                                    {"rocks missed", 0, &BenchRow::rocks_missed},
                                                    {"drift [%]", 2, &BenchRow::odometry_drift_percent},
                                                    {"cross-track rms [m]", 3, &BenchRow::cross_track_rms_m},
                                                    {"final error [m]", 2, &BenchRow::final_error_m},
                                                    {"speed [m/h]", 0, &BenchRow::mean_speed_m_per_h},
                                                    {"x real time", 1, &BenchRow::realtime_factor}};
  return kColumns;
}

Rows of_scenario(const Rows& rows, const std::string& scenario) {
  Rows out;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(out),
               [&](const BenchRow& row) { return row.scenario == scenario; });
  return out;
}

std::string paper_table(const Rows& runs) {
  std::string out =
      "| | planned [m] | driven [m] | driven / planned | repairs |\n|---|---|---|---|---|\n"
      "| paper, first traverse | 86.0 | | | 6 |\n"
      "| paper, second traverse | 62.2 | | | 10 |\n"
      "| paper, both | 148.2 | 176.9 | 1.19 | 16 |\n";
  for (const auto& [scenario, paper] : kPaper) {
    const Rows rows = of_scenario(runs, scenario);
    const auto mid = [&](const RowFigure& figure, int decimals) {
      return decimal(median(values(rows, figure)), decimals);
    };
    out += fmt::format("| here, {}, median of {} | {} | {} | {} | {} |\n", scenario, rows.size(),
                       mid([](const BenchRow& r) { return r.planned_length_m; }, 1),
                       mid([](const BenchRow& r) { return r.driven_length_m; }, 1),
                       mid([](const BenchRow& r) { return r.path_ratio; }, 3),
                       mid([](const BenchRow& r) { return r.replans; }, 0));
  }
  const double planned = sum(runs, [](const BenchRow& r) { return r.planned_length_m; });
  const double driven = sum(runs, [](const BenchRow& r) { return r.driven_length_m; });
  return out + fmt::format("| here, all {} runs | {} | {} | {} | {} |\n", runs.size(), decimal(planned, 1),
                           decimal(driven, 1), decimal(driven / planned, 3),
                           decimal(sum(runs, [](const BenchRow& r) { return r.replans; }), 0));
}

}  // namespace

std::vector<Gate> seed_gates(const std::vector<BenchRow>& all) {
  const Rows rows = by_seed(all);
  const auto reached =
      std::count_if(rows.begin(), rows.end(), [](const BenchRow& row) { return row.outcome == "goal_reached"; });
  std::vector<Gate> gates;
  gates.push_back({fmt::format("every run reaches the goal, at least {} runs", kRuns),
                   fmt::format("{} of {}", reached, rows.size()), reached == std::ssize(rows) && reached >= kRuns});
  gates.push_back(all_gate(
      rows, "0 collisions", 0, [](const BenchRow& r) { return r.collisions; },
      [](const BenchRow&, double v) { return v == 0.0; }));
  gates.push_back(all_gate(
      rows, "0 rocks missed", 0, [](const BenchRow& r) { return r.rocks_missed; },
      [](const BenchRow&, double v) { return v == 0.0; }));
  gates.push_back(all_gate(
      rows, "no fault raised", 0, [](const BenchRow& r) { return r.faults; },
      [](const BenchRow&, double v) { return v == 0.0; }));
  gates.push_back(median_gate(
      rows, "median path ratio at most 1.12", 3, [](const BenchRow& r) { return r.path_ratio; }, 1.12));
  gates.push_back(median_gate(
      rows, "median odometry drift at most 1.0 %", 2, [](const BenchRow& r) { return r.odometry_drift_percent; }, 1.0));
  gates.push_back(all_gate(
      rows, "cross-track rms at most 0.10 m", 3, [](const BenchRow& r) { return r.cross_track_rms_m; },
      [](const BenchRow&, double v) { return v <= 0.10; }));
  gates.push_back(all_gate(
      rows, "final error at most 2 % of the length", 2, [](const BenchRow& r) { return r.final_error_m; },
      [](const BenchRow& r, double v) { return v <= 0.02 * r.planned_length_m; }));
  gates.push_back(min_gate(
      rows, "duty at least 0.75, stops included", 3, [](const BenchRow& r) { return r.duty; }, 0.75));
  const bool deterministic =
      !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const BenchRow& r) { return r.deterministic; });
  gates.push_back({"every run deterministic", deterministic ? "yes" : "no", deterministic});
  return gates;
}

std::vector<BenchRow> newest_rows(const std::vector<BenchRow>& rows) {
  std::map<std::string, std::string> commit_of_level;
  for (const BenchRow& row : rows) commit_of_level[row.level] = row.commit;
  std::map<std::tuple<std::string, std::string, std::int64_t>, BenchRow> last;
  for (const BenchRow& row : rows)
    if (row.commit == commit_of_level[row.level]) last[{row.level, row.scenario, row.seed}] = row;
  Rows out;
  for (const auto& [key, row] : last) out.push_back(row);
  return out;
}

std::string bench_table(const BenchContext& context, const std::vector<BenchRow>& rows) {
  const Rows runs = by_seed(rows);
  std::string out =
      fmt::format("# Bench `{}`\n\n- commit: `{}`\n- machine: {}, {} cores\n- command: `{}`\n\n", context.suite,
                  rows.empty() ? "none" : rows.front().commit, context.cpu_model, context.cores, context.command);
  out += "## Requirements\n\n" + gates_table(seed_gates(rows));
  const auto mid = [&](const RowFigure& figure, int decimals) {
    return decimal(median(values(runs, figure)), decimals);
  };
  out += fmt::format("\nMedian progress {}, regret {}, duty {}, mean speed {} m/h.\n\nTime by cause [%]: {}.\n\n{}\n",
                     mid(&BenchRow::progress, 3), mid(&BenchRow::regret, 3), mid(&BenchRow::duty, 3),
                     mid(&BenchRow::mean_speed_m_per_h, 0), time_by_cause(runs), consistency_line(runs));
  out +=
      "\nRuns share the machine when there is more than one at a time; real time is measured by `./rover bench "
      "speed`.\n";
  out += "\n## Comparison with the paper\n\n" + paper_table(runs) + "\n## Runs\n\n" + runs_head(seed_columns());
  for (const BenchRow& row : runs) out += run_line(row, seed_columns());
  for (const auto& [scenario, paper] : kPaper)
    out += median_line(scenario, of_scenario(runs, scenario), seed_columns());
  return out;
}

const BenchSuite* find_suite(const std::string& name) {
  static constexpr std::array kSuites = {BenchSuite{"seed", bench_table, seed_gates},
                                         BenchSuite{"default", success_table, success_gates}};
  const auto suite = std::find_if(kSuites.begin(), kSuites.end(),
                                  [&](const BenchSuite& known) { return std::string_view(known.name) == name; });
  return suite == kSuites.end() ? nullptr : &*suite;
}

}  // namespace rover::report
