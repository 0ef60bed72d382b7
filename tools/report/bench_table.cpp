#include "tools/report/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace rover::report {
namespace {

constexpr int kRunsOfEach = 10;

struct PaperTraverse {
  int min_repairs;
  const char* planned;
  const char* driven;
  const char* ratio;
  const char* repairs;
};
// Azkarate et al. 2020: two field traverses, 148.2 m planned and 176.9 m driven in total.
const std::map<std::string, PaperTraverse> kPaper = {{"seed_traverse_1", {5, "86.0", "", "", "6"}},
                                                     {"seed_traverse_2", {8, "62.2", "", "", "10"}}};

std::string decimal(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "n/a";
}

using Rows = std::vector<BenchRow>;
using RowFigure = std::function<double(const BenchRow&)>;

std::vector<double> values(const Rows& rows, const RowFigure& figure) {
  std::vector<double> out;
  for (const BenchRow& row : rows) out.push_back(figure(row));
  return out;
}

bool is_seed_traverse(const BenchRow& row) {
  return kPaper.contains(row.scenario);
}

// The first ten valid runs of each seed traverse, by seed.
Rows counted(const Rows& rows) {
  Rows sorted;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(sorted),
               [](const BenchRow& row) { return is_seed_traverse(row) && counts(row); });
  std::sort(sorted.begin(), sorted.end(), [](const BenchRow& a, const BenchRow& b) {
    return std::tie(a.scenario, a.seed) < std::tie(b.scenario, b.seed);
  });
  Rows taken;
  std::map<std::string, int> of_scenario;
  for (const BenchRow& row : sorted)
    if (++of_scenario[row.scenario] <= kRunsOfEach) taken.push_back(row);
  return taken;
}

// An unknown (NaN) metric never meets a requirement.
Gate all_gate(const Rows& rows, const std::string& requirement, int decimals, const RowFigure& figure,
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

std::string row_line(const BenchRow& row) {
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.scenario,
      row.seed, row.outcome, decimal(row.planned_length_m, 1), decimal(row.driven_length_m, 1),
      decimal(row.path_ratio, 3), decimal(row.replans, 0), decimal(row.hazard_stops, 0), decimal(row.collisions, 0),
      decimal(row.rocks_missed, 0) + " / " + decimal(row.rocks_encountered, 0), decimal(row.false_stops, 0),
      decimal(row.odometry_drift_percent, 2), decimal(row.cross_track_rms_m, 3), decimal(row.final_error_m, 2),
      decimal(row.mean_speed_m_per_h, 0), decimal(row.duty, 3), decimal(row.realtime_factor, 1),
      row.deterministic ? "yes" : "no");
}

constexpr char kHead[] =
    "| scenario | seed | outcome | planned [m] | driven [m] | ratio | repairs | hazard stops | collisions | rocks "
    "missed / encountered | false stops | drift [%] | cross-track rms [m] | final error [m] | speed [m/h] | duty | x "
    "real time "
    "| deterministic |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";

std::string median_line(const std::string& scenario, const Rows& rows) {
  const auto mid = [&](const RowFigure& figure, int decimals) {
    return decimal(median(values(rows, figure)), decimals);
  };
  return fmt::format(
      "| **{}** | **median of {}** | | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | |\n",
      scenario, rows.size(), mid([](const BenchRow& r) { return r.planned_length_m; }, 1),
      mid([](const BenchRow& r) { return r.driven_length_m; }, 1),
      mid([](const BenchRow& r) { return r.path_ratio; }, 3), mid([](const BenchRow& r) { return r.replans; }, 0),
      mid([](const BenchRow& r) { return r.hazard_stops; }, 0), mid([](const BenchRow& r) { return r.collisions; }, 0),
      mid([](const BenchRow& r) { return r.rocks_missed; }, 0), mid([](const BenchRow& r) { return r.false_stops; }, 0),
      mid([](const BenchRow& r) { return r.odometry_drift_percent; }, 2),
      mid([](const BenchRow& r) { return r.cross_track_rms_m; }, 3),
      mid([](const BenchRow& r) { return r.final_error_m; }, 2),
      mid([](const BenchRow& r) { return r.mean_speed_m_per_h; }, 0), mid([](const BenchRow& r) { return r.duty; }, 3),
      mid([](const BenchRow& r) { return r.realtime_factor; }, 1));
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

// Time in each state, which limits the duty cycle, and losses by point turns and slow ground while driving.
std::string time_lines(const Rows& runs) {
  std::map<std::string, double> spent;
  double total = 0.0;
  double turning = 0.0;
  for (const BenchRow& row : runs) {
    if (!std::isfinite(row.duration_s)) continue;
    total += row.duration_s;
    turning += std::isfinite(row.point_turn_s) ? row.point_turn_s : 0.0;
    for (const auto& [state, seconds] : row.time_in_state_s) spent[state] += seconds;
  }
  if (total <= 0.0) return "";
  std::string out = "\nTime by state:";
  for (const auto& [state, seconds] : spent)
    if (seconds > 0.0) out += fmt::format(" {} {} %,", state, decimal(100.0 * seconds / total, 1));
  return out + fmt::format(" of which point turns {} %.\n", decimal(100.0 * turning / total, 1));
}

}  // namespace

int min_repairs(const std::string& scenario) {
  const auto it = kPaper.find(scenario);
  return it == kPaper.end() ? 0 : it->second.min_repairs;
}

bool counts(const BenchRow& row) {
  // A failed run always counts, however few repairs it has.
  const bool failed = row.outcome != "goal_reached" || !(row.collisions == 0.0) || !(row.rocks_missed == 0.0);
  return failed || row.replans >= min_repairs(row.scenario);
}

double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<Gate> seed_gates(const std::vector<BenchRow>& all) {
  const Rows rows = counted(all);
  const auto reached =
      std::count_if(rows.begin(), rows.end(), [](const BenchRow& row) { return row.outcome == "goal_reached"; });
  constexpr int kWanted = 2 * kRunsOfEach;
  std::vector<Gate> gates;
  gates.push_back({fmt::format("{0} of {0} runs reach the goal", kWanted),
                   fmt::format("{} of {}", reached, rows.size()),
                   reached == kWanted && static_cast<int>(rows.size()) == kWanted});
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
  std::map<std::pair<std::string, std::int64_t>, BenchRow> last;
  for (const BenchRow& row : rows)
    if (row.commit == rows.back().commit) last[{row.scenario, row.seed}] = row;
  Rows out;
  for (const auto& [key, row] : last) out.push_back(row);
  return out;
}

std::string bench_table(const BenchContext& context, const std::vector<BenchRow>& all) {
  const Rows rows = newest_rows(all);
  const Rows runs = counted(rows);
  std::string out =
      fmt::format("# Bench `{}`\n\n- commit: `{}`\n- machine: {}, {} cores\n- command: `{}`\n\n", context.suite,
                  rows.empty() ? "none" : rows.front().commit, context.cpu_model, context.cores, context.command);
  out += "## Requirements\n\n| requirement | measured | met |\n|---|---|---|\n";
  for (const Gate& gate : seed_gates(rows))
    out += fmt::format("| {} | {} | {} |\n", gate.requirement, gate.measured, gate.met ? "yes" : "**no**");
  out += fmt::format("\nMean speed, median: {} m/h.\n",
                     decimal(median(values(runs, [](const BenchRow& r) { return r.mean_speed_m_per_h; })), 0));
  out += time_lines(runs);
  out +=
      "\nRuns share the machine when there is more than one at a time; real time is measured by `./rover bench "
      "speed`.\n";
  out += "\n## Comparison with the paper\n\n" + paper_table(runs) + "\n## Runs\n\n" + kHead;
  for (const BenchRow& row : runs) out += row_line(row);
  for (const auto& [scenario, paper] : kPaper) out += median_line(scenario, of_scenario(runs, scenario));
  std::string others;
  for (const BenchRow& row : rows) {
    const auto same = [&](const BenchRow& run) { return run.scenario == row.scenario && run.seed == row.seed; };
    if (std::none_of(runs.begin(), runs.end(), same)) others += row_line(row);
  }
  if (!others.empty())
    out +=
        "\n## Not counted\n\nReached the goal with fewer repairs than required (first traverse 5, second 8), or "
        "beyond the first ten that count.\n\n" +
        std::string(kHead) + others;
  return out;
}

}  // namespace rover::report
