#include "tools/report/fidelity_json.hpp"

#include <cmath>

#include "common/core/statistics.hpp"

namespace rover::report {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

// Four digits are more than the counts support.
Json ratio(double value) {
  return number(std::round(value * 1e4) / 1e4);
}

template <class F>
Json table(const MapFidelity& map, F&& figure) {
  Json rows = Json::array();
  for (const auto& of_height : map.counts) {
    Json row = Json::array();
    for (const FidelityCount& count : of_height) row.push_back(figure(count));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json fidelity_json(const std::optional<MapFidelity>& map) {
  if (!map) return nullptr;
  const auto bound = [](double Interval::*end) {
    return [end](const FidelityCount& count) { return ratio(count.interval().*end); };
  };
  return {{"maps", map->maps},
          {"observed_cells", map->observed_cells},
          {"area_ratio", number(map->area_ratio)},
          {"ideal_area_ratio", number(map->ideal_area_ratio)},
          {"changes_per_cell", number(map->changes_per_cell)},
          {"rocks", map->rocks},
          {"rocks_never_closed", map->rocks_never_closed},
          {"first_closed_median_m", number(map->first_closed_median_m)},
          {"first_closed_p10_m", number(map->first_closed_p10_m)},
          {"height_m", kFidelityHeightsM},
          {"range_m", kFidelityRangesM},
          {"impassable", table(*map, [](const FidelityCount& count) { return ratio(count.ratio()); })},
          {"lower", table(*map, bound(&Interval::low))},
          {"upper", table(*map, bound(&Interval::high))},
          {"looks", table(*map, [](const FidelityCount& count) { return count.looks; })},
          {"cells", table(*map, [](const FidelityCount& count) { return count.cells; })}};
}

}  // namespace

Json anees_json(const PoseConsistency& pose) {
  if (pose.samples == 0) return nullptr;
  const Interval bounds = mean_nees_bounds(3);
  return {{"x", number(pose.x)},     {"y", number(pose.y)}, {"yaw", number(pose.yaw)}, {"xyyaw", number(pose.xyyaw)},
          {"samples", pose.samples}, {"lower", bounds.low}, {"upper", bounds.high}};
}

Json vo_nees_json(const VisualConsistency& visual) {
  if (visual.keyframes == 0) return nullptr;
  const Interval bounds = mean_nees_bounds(6.0 * visual.keyframes);
  return {{"translation", number(visual.translation)},
          {"rotation", number(visual.rotation)},
          {"together", number(visual.together)},
          {"keyframes", visual.keyframes},
          {"lower", bounds.low},
          {"upper", bounds.high}};
}

Json map_json(const MapFidelities& maps) {
  return {{"hazards", fidelity_json(maps.hazards)}, {"traversability", fidelity_json(maps.traversability)}};
}

}  // namespace rover::report
