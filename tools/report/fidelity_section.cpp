#include "tools/report/fidelity_section.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/core/statistics.hpp"
#include "tools/report/html_parts.hpp"

namespace rover::report {
namespace {

std::string consistency_row(const char* when, const PoseConsistency& pose) {
  if (pose.samples == 0) return {};
  return fmt::format(
      "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
      "<td class=\"n\">{}</td></tr>\n",
      when, pose.samples, shown(pose.x, 2), shown(pose.y, 2), shown(pose.yaw, 2), shown(pose.xyyaw, 2));
}

std::string consistency_table(const Metrics& m) {
  const bool fixed = m.anees_after_fix.samples > 0;
  const std::string rows = consistency_row(fixed ? "before the first correction" : "whole drive", m.anees) +
                           consistency_row("after it", m.anees_after_fix);
  if (rows.empty()) return {};
  const Interval single = mean_nees_bounds(1);
  const Interval together = mean_nees_bounds(3);
  return "<h2>Consistency of the pose</h2><table><tr><th></th><th class=\"n\">samples</th><th class=\"n\">x</th>"
         "<th class=\"n\">y</th><th class=\"n\">yaw</th><th class=\"n\">x, y, yaw</th></tr>\n" +
         rows +
         fmt::format(
             "</table><p class=\"meta\">Squared error over its covariance, averaged and divided by the degrees of "
             "freedom: 1 is consistent, more is overconfident. The samples of a run are correlated: one run is "
             "suspicious only outside {:.3f} to {:.2f} (x, y, yaw alone) or {:.2f} to {:.2f} (together).</p>\n",
             single.low, single.high, together.low, together.high);
}

std::string height_label(size_t i) {
  if (i == 0) return fmt::format("below {:.2f} m", kFidelityHeightsM[0]);
  if (i == kFidelityHeightsM.size()) return fmt::format("from {:.2f} m", kFidelityHeightsM.back());
  return fmt::format("{:.2f} to {:.2f} m", kFidelityHeightsM[i - 1], kFidelityHeightsM[i]);
}

std::string count_cell(const FidelityCount& count) {
  if (count.looks == 0) return "<td class=\"n\"></td>";
  const Interval interval = count.interval();
  return fmt::format("<td class=\"n\">{:.1f} <span class=\"meta\">{:.1f} - {:.1f}</span></td>", 100.0 * count.ratio(),
                     100.0 * interval.low, 100.0 * interval.high);
}

bool any_looks(const MapFidelity& map, size_t range) {
  for (const auto& of_height : map.counts)
    if (of_height[range].looks > 0) return true;
  return false;
}

std::string map_table(const char* channel, const MapFidelity& map) {
  std::string head = fmt::format("<table><tr><th>{}: true height</th>", channel);
  for (size_t range = 0; range < kRangeClasses; ++range)
    if (any_looks(map, range))
      head += fmt::format("<th class=\"n\">{:.0f} - {:.0f} m</th>", range == 0 ? 0.0 : kFidelityRangesM[range - 1],
                          kFidelityRangesM[range]);
  std::string rows;
  for (size_t height = 0; height < kHeightClasses; ++height) {
    rows += "<tr><td>" + height_label(height) + "</td>";
    for (size_t range = 0; range < kRangeClasses; ++range)
      if (any_looks(map, range)) rows += count_cell(map.counts[height][range]);
    rows += "</tr>\n";
  }
  return head + "</tr>\n" + rows +
         fmt::format(
             "</table><p class=\"meta\">{} maps. Impassable area: {} times the true area of at least 0.15 m (a perfect "
             "map of these cells: {}). Changes of a cell between passable and impassable: {}. Of {} rocks of at least "
             "0.15 m {} were never closed, the others first at {} (10th percentile {}) from the camera.</p>\n",
             map.maps, shown(map.area_ratio, 2), shown(map.ideal_area_ratio, 2), shown(map.changes_per_cell, 2),
             map.rocks, map.rocks_never_closed, shown(map.first_closed_median_m, 1, "m"),
             shown(map.first_closed_p10_m, 1, "m"));
}

}  // namespace

std::string fidelity_section(const Metrics& m) {
  std::string out = consistency_table(m);
  if (!m.map.hazards && !m.map.traversability) return out;
  out +=
      "<h2>Fidelity of the maps</h2><p class=\"meta\">Observed cells that the map calls impassable, in percent with "
      "their 95 % interval, by true height over the local ground and by distance from the camera.</p>\n";
  if (m.map.hazards) out += map_table("HAZARDS", *m.map.hazards);
  if (m.map.traversability) out += map_table("TRAVERSABILITY", *m.map.traversability);
  return out;
}

}  // namespace rover::report
