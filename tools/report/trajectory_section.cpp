#include "tools/report/trajectory_section.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/report/no_truth.hpp"

namespace rover::report {
namespace {

std::string cell(double value, int decimals, const char* unit) {
  return "<td class=\"n\">" + (std::isfinite(value) ? fmt::format("{:.{}f} {}", value, decimals, unit) : "n/a") +
         "</td>";
}

std::string row(const char* name, const TrajectoryError& error) {
  std::string out = fmt::format("<tr><td>{}</td><td class=\"n\">{}</td>", name, error.poses) +
                    cell(error.end_error_percent, 2, "%") + cell(error.ate_rmse_m, 3, "m");
  for (const SegmentError& s : error.segments) out += cell(s.translation_percent, 2, "%");
  return out + cell(error.all_segments.translation_percent, 2, "%") +
         cell(error.all_segments.rotation_deg_per_m, 4, "deg/m") + "</tr>\n";
}

}  // namespace

std::string trajectory_section(const Metrics& m) {
  if (!m.info.data_set_pairs || !has_truth(m)) return {};
  std::string out =
      "<h2>Comparison with the ground truth</h2><table><tr><th></th><th class=\"n\">poses</th><th class=\"n\">end "
      "error</th><th class=\"n\">after alignment, rms</th>";
  for (const SegmentError& s : m.visual_odometry.segments)
    out += fmt::format("<th class=\"n\">{:.0f} m</th>", s.length_m);
  out += "<th class=\"n\">all segments</th><th class=\"n\">rotation</th></tr>\n";
  out += row("visual odometry", m.visual_odometry) + row("published pose", m.published_pose);
  return out +
         fmt::format(
             "</table><p class=\"meta\">{} stereo pairs; visual odometry published {} motions between them, {} of "
             "them lost. Segment errors by the KITTI metric.</p>\n",
             *m.info.data_set_pairs, m.vo_frames, m.vo_lost);
}

}  // namespace rover::report
