// What the drives of a cell, or of a campaign, came to.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/row.hpp"

namespace rover::campaign {

using Drives = std::vector<const Row*>;

// NaN if the row lacks it.
double figure_of(const Row& row, const std::string& figure);
bool reached_goal(const Row& row);
// The oracle finds no path on the true world. A drive without oracle counts as feasible.
bool is_infeasible(const Row& row);

struct SuccessCount {
  int drives = 0;
  int feasible = 0;
  int reached = 0;             // of the feasible ones
  int reached_infeasible = 0;  // the oracle's model is stricter than the ground
  int infeasible = 0;
  int without_oracle = 0;
  int died = 0;
  double contacts = 0.0;
  int unknown_contacts = 0;  // drives with a result, but without this count
};
SuccessCount count(const Drives& drives);

// A figure of the small multiples.
struct ShownFigure {
  const char* key;  // of Row::figures
  const char* title;
  int decimals;
  bool higher_is_better;
  bool reached_only;  // a drive that stopped early would look better than it is
};
inline constexpr ShownFigure kShownFigures[] = {
    {"path_ratio", "Driven / planned", 2, false, true},
    {"regret", "Regret: driven / oracle", 2, false, true},
    {"progress", "Progress: planned / (0.2 m/s x time)", 2, true, false},
    {"hazard_stops", "Hazard stops", 0, false, false},
    {"replans", "Replans", 0, false, false},
};
// Beside those in tables, if a drive has them.
inline constexpr ShownFigure kTableFigures[] = {
    {"false_stops", "False stops", 0, false, false},
    {"rocks_missed", "Rocks missed", 0, false, false},
    {"odometry_drift_percent", "Odometry drift [%]", 2, false, false},
    {"slam_odometry_ratio", "SLAM / odometry error", 2, false, false},
    {"final_estimate_error_m", "POSE off at the end [m]", 2, false, false},
    {"corrected_error_max_m", "POSE off after the first fix, at most [m]", 2, false, false},
    {"anees_after_fix.xyyaw", "ANEES of POSE after it", 2, false, false},
};

// Figures and texts of a row that page and comparison use.
std::vector<std::string> page_columns();

// The figure of a drive, NaN if it does not count for this figure: not feasible, or not at its goal.
double shown_value(const Row& row, const ShownFigure& figure);

struct Spread {
  int drives = 0;
  double median;
  double worst;
};
Spread spread(const Drives& drives, const ShownFigure& figure);

// Why a drive failed: outcome, and the fault that stopped it; "died" without a result.
struct Cause {
  std::string name;
  Drives drives;  // the worst one first: contacts, then the lowest progress
};
// Of the feasible drives, and of all with contact or without result; the most frequent cause first.
std::vector<Cause> causes(const Drives& drives);

// "1 drive", "2 drives".
std::string counted(double number, const std::string& what);

Drives pointers(const std::vector<Row>& rows);
std::map<Cell, Drives> by_cell(const Drives& drives);

}  // namespace rover::campaign
