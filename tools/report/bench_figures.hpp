// Parts of the result tables of benchmarks.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/report/bench_table.hpp"

namespace rover::report {

using BenchRows = std::vector<BenchRow>;
using RowFigure = std::function<double(const BenchRow&)>;

// "n/a" if unknown.
std::string decimal(double value, int decimals);
std::vector<double> values(const BenchRows& rows, const RowFigure& figure);

// An unknown (NaN) figure of any row never meets a requirement.
Gate all_gate(const BenchRows& rows, const std::string& requirement, int decimals, const RowFigure& figure,
              const std::function<bool(const BenchRow&, double)>& met);
std::string gates_table(const std::vector<Gate>& gates);

struct BenchColumn {
  const char* title;
  int decimals;
  RowFigure figure;
};
// Scenario, seed, outcome, the columns, and the time by cause of each run.
std::string runs_head(const std::vector<BenchColumn>& columns);
std::string run_line(const BenchRow& row, const std::vector<BenchColumn>& columns);
std::string median_line(const std::string& what, const BenchRows& rows, const std::vector<BenchColumn>& columns);

// Percentages of the whole time, e.g. "straight 33.1, curve 49.0"; causes below 0.05 % are left out.
std::string time_by_cause(const BenchRows& rows);

// ANEES of POSE over all rows, with the bounds of a consistent filter. The errors of a row are one correlated value.
std::string consistency_line(const BenchRows& rows);

}  // namespace rover::report
