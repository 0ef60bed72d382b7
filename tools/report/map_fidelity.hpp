// Fidelity of the rover's maps (HAZARDS, TRAVERSABILITY) against the true surface. Cells are placed by the true pose at
// the time of the map, so localization errors do not count, except those within one map.
#pragma once

#include <array>
#include <optional>

#include "common/core/statistics.hpp"
#include "tools/report/track.hpp"

namespace rover::report {

// Upper ends of the classes; the last class of heights is open.
constexpr std::array kFidelityHeightsM = {0.05, 0.10, 0.15, 0.20};
constexpr std::array kFidelityRangesM = {1.0, 2.0, 3.0, 4.0, 6.0, 8.0};
constexpr size_t kHeightClasses = kFidelityHeightsM.size() + 1;
constexpr size_t kRangeClasses = kFidelityRangesM.size();
constexpr double kAreaRangeM = 4.0;  // area ratio: within this distance of the camera
constexpr double kSeenRangeM = 3.0;  // a rock whose centre was observed from here must be closed

// Observed cells of one class of true height and range.
struct FidelityCount {
  int looks = 0;       // a cell counts once in each map
  int impassable = 0;  // of them
  int cells = 0;       // different places of 0.1 m
  double ratio() const { return looks > 0 ? static_cast<double>(impassable) / looks : kNaN; }
  // Looks at one place are correlated: it has as many trials as there are places.
  Interval interval() const { return wilson(ratio() * cells, cells); }
};

struct MapFidelity {
  int maps = 0;
  std::array<std::array<FidelityCount, kRangeClasses>, kHeightClasses> counts{};
  double area_ratio = kNaN;        // impassable area / true area of a surface of at least 0.15 m
  double ideal_area_ratio = kNaN;  // the same of a perfect map of the same cells
  int observed_cells = 0;          // different places of 0.1 m
  double changes_per_cell = kNaN;  // between passable and impassable
  int rocks = 0;                   // of at least 0.15 m, closed or with their centre observed within 3 m
  int rocks_never_closed = 0;
  double first_closed_median_m = kNaN;  // distance from the camera to the rock's rim
  double first_closed_p10_m = kNaN;
};

struct MapFidelities {
  std::optional<MapFidelity> hazards;
  std::optional<MapFidelity> traversability;
};

// Maps of the window. Empty without maps, or if the world's heights are unknown.
MapFidelities map_fidelities(const RunRecord& run, const TrueTrack& truth, const Window& window,
                             const Footprint& footprint, const TrueWorld& world);

}  // namespace rover::report
