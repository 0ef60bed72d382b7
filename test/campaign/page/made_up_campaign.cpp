#include "made_up_campaign.hpp"

#include <algorithm>
#include <cmath>

namespace rover::campaign {
namespace {

constexpr double kPlannedM = 80.0;

// Uniform in [0, 1), by what it is for (FNV-1a).
double chance(const Cell& cell, std::int64_t seed, const char* purpose) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : cell_text(cell) + std::to_string(seed) + purpose)
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  hash ^= hash >> 29;
  hash *= 0xbf58476d1ce4e5b9ull;
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

std::vector<Cell> cells() {
  std::vector<Cell> out;
  for (const char* level : {"efficient", "full"})
    for (const char* rocks : {"0.05", "0.07", "0.1", "0.12", "0.15", "0.2"})
      for (const char* slope : {"0", "5", "10", "15"})
        for (const char* direction : {"down", "up", "across"}) {
          if (std::string(level) == "efficient" && std::stod(rocks) > 0.1) continue;
          const bool flat = std::string(slope) == "0";
          if (flat && std::string(direction) != "down") continue;
          out.push_back({{"scenario", "enav"},
                         {"level", level},
                         {"perception", "geometric"},
                         {"rock_area", rocks},
                         {"slope_deg", slope},
                         {"slope_direction", flat ? "flat" : direction}});
        }
  return out;
}

// 0 on easy ground, 1 on the hardest.
double difficulty(const Cell& cell) {
  const double rocks = std::stod(cell.at("rock_area")) / 0.2;
  const double slope = std::stod(cell.at("slope_deg")) / 15.0;
  const double up = cell.at("slope_direction") == "down" ? 0.8 : 1.0;
  return std::min(1.0, 0.75 * rocks * rocks + 0.25 * slope * up) * (cell.at("level") == "efficient" ? 1.6 : 1.0);
}

void add_failure(Row& row, double hard) {
  const double kind = chance(row.cell, row.seed, "kind");
  row.outcome = kind < 0.6 ? "no_path" : kind < 0.85 ? "timeout" : "fault_stop";
  if (row.outcome == "fault_stop") row.texts["fault"] = kind < 0.93 ? "slip_high" : "tilt_high";
  const double part = 0.9 * chance(row.cell, row.seed, "part");
  row.figures["driven_length_m"] = kPlannedM * part;
  row.figures["progress"] = 0.75 * part * (1.0 - 0.5 * hard);
}

void add_success(Row& row, double hard, double improvement) {
  const double spread = chance(row.cell, row.seed, "detour");
  const double regret = 1.0 + (1.0 - improvement) * hard * (0.08 + 0.6 * spread * spread * spread);
  const double oracle = kPlannedM * (1.0 + 0.12 * hard);
  row.outcome = "goal_reached";
  row.figures["oracle_m"] = oracle;
  row.figures["regret"] = regret;
  row.figures["driven_length_m"] = oracle * regret;
  row.figures["path_ratio"] = oracle * regret / kPlannedM;
  row.figures["progress"] = 0.93 / (1.12 * regret * regret);
}

Row row_of(const Cell& cell, std::int64_t seed, const MadeUp& what) {
  const double hard = difficulty(cell);
  Row row{.commit = "0123456789ab", .cell = cell, .seed = seed, .status = "done"};
  row.figures["planned_length_m"] = kPlannedM;
  row.figures["collisions"] = 0.0;
  const bool feasible = chance(cell, seed, "world") > 0.25 * hard * hard * hard;
  row.figures["oracle_feasible"] = feasible ? 1.0 : 0.0;
  if (chance(cell, seed, "machine") < 0.0005) {
    return {.commit = row.commit,
            .cell = cell,
            .seed = seed,
            .attempts = 2,
            .status = "died",
            .texts = {{"reason", "no metrics"}}};
  }
  if (!feasible || chance(cell, seed, "drive") < 0.45 * hard * hard * (1.0 - what.improvement))
    add_failure(row, std::min(hard, 1.0));
  else
    add_success(row, hard, what.improvement);
  row.figures["duration_s"] = std::round(kPlannedM / 0.2 / std::max(row.figures["progress"], 0.2));
  row.figures["hazard_stops"] = std::floor(9.0 * hard * chance(cell, seed, "stops") * (1.0 - 0.5 * what.improvement));
  row.figures["replans"] = std::floor(4.0 + 40.0 * hard * (0.4 + chance(cell, seed, "replans")));
  return row;
}

}  // namespace

std::vector<Row> made_up_rows(const MadeUp& what) {
  std::vector<Row> rows;
  for (const Cell& cell : cells())
    for (int seed = 1; seed <= what.seeds; ++seed) rows.push_back(row_of(cell, seed, what));
  return rows;
}

std::vector<Job> made_up_jobs(const std::vector<Row>& rows) {
  std::vector<Job> jobs;
  for (const Row& row : rows)
    jobs.push_back({.cell = row.cell,
                    .seed = row.seed,
                    .scenario = "scenarios/enav-rock_area-" + row.cell.at("rock_area") + "-slope_deg-" +
                                row.cell.at("slope_deg") + "-slope_direction-" + row.cell.at("slope_direction") +
                                ".yaml",
                    .level = row.cell.at("level"),
                    .perception = row.cell.at("perception"),
                    .set = {}});
  return jobs;
}

}  // namespace rover::campaign
