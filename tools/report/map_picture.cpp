#include "tools/report/map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/map_layers.hpp"
#include "tools/report/no_truth.hpp"
#include "tools/report/palette.hpp"
#include "tools/report/slope_map.hpp"

namespace rover::report {
namespace {

constexpr double kLegend = 40.0;
constexpr double kLegendRow = 26.0;
constexpr double kHazardCellM = 0.1;

// Layers that the page can switch; the picture alone shows those that are initially on.
template <class Draw>
void in_layer(Svg& svg, MapLayer layer, Draw draw) {
  const MapLayerInfo& info = kMapLayers[static_cast<size_t>(layer)];
  svg.begin_group(fmt::format("class=\"layer-{}\"{}{}", info.id, info.on ? "" : " display=\"none\"",
                              layer == MapLayer::kSlope ? " opacity=\".7\"" : ""));
  draw();
  svg.end();
}

void draw_ground(Svg& svg, const MapView& view, const HeightRaster& orbital) {
  svg.rect(view.left, view.top, view.width(), view.height(), "fill:#e9d9c6");
  if (orbital.empty()) return;
  const auto pixels = [](double px) { return std::max(8, static_cast<int>(std::lround(px))); };
  const int columns = pixels(view.width());
  const int rows = pixels(view.height());
  in_layer(svg, MapLayer::kRelief, [&] {
    svg.jpeg(view.left, view.top, view.width(), view.height(),
             relief_jpeg(orbital, view.box, columns, rows, ReliefStyle{}));
  });
  // A lower resolution is sufficient here.
  in_layer(svg, MapLayer::kSlope, [&] {
    svg.jpeg(view.left, view.top, view.width(), view.height(),
             slope_jpeg(orbital, view.box, std::max(8, columns / 2), std::max(8, rows / 2)));
  });
}

void draw_hazards(Svg& svg, const MapView& view, const Scene& scene) {
  const TrueTrack truth(scene.run.truth);
  if (truth.empty()) return;
  Points obstacles;
  Points holes;
  for (const HazardMap& map : scene.run.hazards) {
    if (map.cells.empty()) continue;
    const Eigen::Isometry3d T_map_body = truth.at(map.t_s);
    for (const HazardCell& cell : map.cells)
      (cell.hole ? holes : obstacles).push_back(cell_in_map(cell, T_map_body, scene.footprint.origin_height_m));
  }
  draw_cells(svg, view, obstacles, kHazardCellM, fmt::format("fill:{};fill-opacity:.5", palette::kHazard));
  draw_cells(svg, view, holes, kHazardCellM, fmt::format("fill:{};fill-opacity:.5", palette::kHole));
}

void draw_tracks(Svg& svg, const MapView& view, const Scene& scene) {
  svg.polyline(view.px(true_line(scene)), stroke("#ffffff", 5.4, "stroke-opacity:.75"));
  if (has_truth(scene.evaluation.metrics)) svg.polyline(view.px(true_line(scene)), stroke(palette::kTruth, 3.0));
  svg.polyline(view.px(estimated_line(scene)), stroke(palette::kEstimate, 1.8, "stroke-dasharray:6 5"));
}

void draw_zones(Svg& svg, const MapView& view, const Scene& scene) {
  const std::vector<PathRecord>& paths = scene.evaluation.metrics.paths;
  if (paths.empty()) return;
  for (const Zone& zone : paths.back().zones) {
    const char* colour = zone.keep_in ? palette::kGood : palette::kBad;
    const std::string fill = zone.keep_in ? "none" : colour;
    svg.polygon(view.px(Points(zone.points.begin(), zone.points.end())),
                stroke(colour, 2.4, fmt::format("stroke-dasharray:10 5;fill:{};fill-opacity:.18", fill)));
  }
}

void draw_paths(Svg& svg, const MapView& view, const Scene& scene) {
  const Points global = view.px(planned_line(scene));
  svg.polyline(global, stroke("#3b2a1e", 4.0, "stroke-opacity:.55"));
  svg.polyline(global, stroke(palette::kGlobalPath, 2.4, "stroke-dasharray:9 6"));
  for (const Incident& incident : scene.evaluation.incidents)
    if (!incident.new_path.empty())
      svg.polyline(view.px(thinned(incident.new_path, 0.1)), stroke(palette::kRepair, 2.0, "stroke-opacity:.75"));
}

std::string oracle_style() {
  return stroke(palette::kOracle, 1.8, "stroke-dasharray:2 4");
}

void draw_markers(Svg& svg, const MapView& view, const Scene& scene) {
  const TrueTrack truth(scene.run.truth);
  if (truth.empty()) return;
  for (size_t i = 0; i < scene.evaluation.incidents.size(); ++i) {
    const Incident& incident = scene.evaluation.incidents[i];
    const Eigen::Vector2d p = view.px(Eigen::Vector2d(truth.at(incident.t_s).translation().head<2>()));
    const char* colour = incident.stopped ? palette::kBad : palette::kRepair;
    // Alternating sides separate the labels of close incidents.
    const double lift = i % 2 == 0 ? -26.0 : 26.0;
    svg.line(p.x(), p.y(), p.x(), p.y() + lift, stroke(colour, 1.5));
    svg.circle(p.x(), p.y(), 3.5, fmt::format("fill:{};stroke:#fff", colour));
    svg.circle(p.x(), p.y() + lift, 11.0, fmt::format("fill:#fff;stroke:{};stroke-width:2", colour));
    svg.text(p.x(), p.y() + lift + 4.5, std::to_string(i + 1), 12.5, fmt::format("font-weight:700;fill:{}", colour),
             Anchor::kMiddle);
  }
}

void draw_ends(Svg& svg, const MapView& view, const Scene& scene) {
  const TrueTrack truth(scene.run.truth);
  const Window& window = scene.evaluation.metrics.window;
  const std::string rover = fmt::format("fill:{0};fill-opacity:.25;stroke:{0};stroke-width:1.6", palette::kTruth);
  if (!truth.empty()) {
    draw_footprint(svg, view, truth.planar_at(window.begin_s), scene.footprint, rover);
    draw_footprint(svg, view, truth.planar_at(window.end_s), scene.footprint, rover);
  }
  const Points global = planned_line(scene);
  if (global.empty()) return;
  const auto label = [&](const Eigen::Vector2d& at, const std::string& text, const char* colour) {
    const Eigen::Vector2d p = view.px(at);
    const double w = 9.0 * static_cast<double>(text.size()) + 12.0;
    svg.circle(p.x(), p.y(), 7.0, fmt::format("fill:{};stroke:#fff;stroke-width:2.4", colour));
    svg.rect(p.x() - 0.5 * w, p.y() + 13.0, w, 20.0, "fill:#fff;fill-opacity:.85", 4.0);
    svg.text(p.x(), p.y() + 27.5, text, 13.5, fmt::format("font-weight:700;fill:{}", colour), Anchor::kMiddle);
  };
  label(global.front(), "Start", palette::kInk);
  label(global.back(), "Goal", palette::kGood);
}

struct LegendEntry {
  std::string text;
  double width;
  double text_at;
  std::function<void(double x, double y)> symbol;
};

void draw_legend(Svg& svg, double left, double top, double right, bool has_truth, bool has_oracle) {
  const auto bar = [&](const std::string& style) {
    return [&svg, style](double x, double y) { svg.line(x, y, x + 30.0, y, style); };
  };
  const auto square = [&](const char* colour) {
    const std::string style = fmt::format("fill:{};fill-opacity:.6", colour);
    return [&svg, style](double x, double y) { svg.rect(x + 2.0, y - 7.0, 14.0, 14.0, style); };
  };
  const auto disc = [&](const std::string& style) {
    return [&svg, style](double x, double y) { svg.circle(x + 9.0, y, 7.0, style); };
  };
  std::vector<LegendEntry> entries = {
      {"planned path", 122, 38,
       [&](double x, double y) {
         svg.line(x, y, x + 30.0, y, stroke("#3b2a1e", 4.5));
         svg.line(x, y, x + 30.0, y, stroke(palette::kGlobalPath, 2.4, "stroke-dasharray:9 6"));
       }},
      {"true track", 106, 38, bar(stroke(palette::kTruth, 3.2))},
      {"estimated track", 142, 38, bar(stroke(palette::kEstimate, 2.2, "stroke-dasharray:6 5"))},
      {"repaired path", 130, 38, bar(stroke(palette::kRepair, 2.4))},
      {"shortest drivable path", 174, 38, bar(oracle_style())},
      {"detected hazard", 132, 24, square(palette::kHazard)},
      {"detected hole", 118, 24, square(palette::kHole)},
      {"rock of 0.15 m or more", 176, 24, disc(fmt::format("fill:{};stroke:#fff", palette::kRock))},
      {"lower rock", 94, 24, disc(fmt::format("fill:{};fill-opacity:.35", palette::kPebble))},
      {"repair", 66, 24, disc(fmt::format("fill:#fff;stroke:{};stroke-width:2", palette::kRepair))},
      {"hazard stop", 100, 24, disc(fmt::format("fill:#fff;stroke:{};stroke-width:2", palette::kBad))},
  };
  if (!has_truth) std::erase_if(entries, [](const LegendEntry& entry) { return entry.text == "true track"; });
  if (!has_oracle)
    std::erase_if(entries, [](const LegendEntry& entry) { return entry.text == "shortest drivable path"; });
  double x = left;
  double y = top + 12.0;
  for (const LegendEntry& entry : entries) {
    if (x + entry.width > right) {
      x = left;
      y += kLegendRow;
    }
    entry.symbol(x, y);
    svg.text(x + entry.text_at, y + 4.5, entry.text, 13, "");
    x += entry.width + 16.0;
  }
}

}  // namespace

std::string draw_map(const Scene& scene) {
  const MapView view = map_view(scene);
  const double bottom = view.top + view.height() + kMapAxis + 6.0;
  const bool has_oracle = !scene.evaluation.oracle_path.empty();  // its entry needs a second row
  const double height = bottom + kLegend + (has_oracle ? kLegendRow : 0.0);
  Svg svg(kMapWidth, height);
  svg.rect(0.0, 0.0, kMapWidth, height, "fill:#fff");
  svg.begin_clip("map-frame", view.left, view.top, view.width(), view.height());
  draw_ground(svg, view, scene.orbital);
  in_layer(svg, MapLayer::kRocks, [&] { draw_rocks(svg, view, scene, RockStyle::kFilled); });
  in_layer(svg, MapLayer::kHazards, [&] { draw_hazards(svg, view, scene); });
  in_layer(svg, MapLayer::kPaths, [&] {
    draw_zones(svg, view, scene);
    draw_paths(svg, view, scene);
  });
  in_layer(svg, MapLayer::kOracle,
           [&] { svg.polyline(view.px(Points(scene.evaluation.oracle_path)), oracle_style()); });
  in_layer(svg, MapLayer::kTracks, [&] { draw_tracks(svg, view, scene); });
  draw_ends(svg, view, scene);
  in_layer(svg, MapLayer::kEvents, [&] { draw_markers(svg, view, scene); });
  svg.end();
  draw_axes(svg, view);
  svg.rect(view.left, view.top, view.width(), view.height(), "fill:none;stroke:#5b4636;stroke-width:1.2");
  draw_scale_bar(svg, view, true_line(scene));
  draw_north(svg, view);
  draw_legend(svg, view.left, bottom + 6.0, kMapWidth - 8.0, has_truth(scene.evaluation.metrics), has_oracle);
  return svg.str();
}

std::string draw_incident(const Scene& scene, size_t index) {
  constexpr double kSide = 340.0;
  constexpr double kBoxM = 7.0;
  const Incident& incident = scene.evaluation.incidents[index];
  const TrueTrack truth(scene.run.truth);
  if (truth.empty()) return {};
  const Pose2 pose = truth.planar_at(incident.t_s);
  const Eigen::Vector2d middle = transform(pose, {1.3, 0.0});
  MapView view;
  view.box = Box{middle.x(), middle.y(), middle.x(), middle.y()}.expanded(0.5 * kBoxM);
  view.top = 26.0;
  view.px_per_m = kSide / kBoxM;
  Svg svg(kSide, kSide + view.top);
  const double distance = truth.distance_m(incident.t_s) - truth.distance_m(scene.evaluation.metrics.window.begin_s);
  svg.text(0.0, 16.0, fmt::format("{}", index + 1), 15,
           fmt::format("font-weight:700;fill:{}", incident.stopped ? palette::kBad : palette::kRepair));
  svg.text(24.0, 16.0, fmt::format("at {:.1f} m: {}", distance, incident_title(scene, index)), 13,
           incident.is_false() && scene.world ? fmt::format("fill:{};font-weight:600", palette::kBad) : "");
  svg.begin_clip(fmt::format("incident-{}", index), view.left, view.top, view.width(), view.height());
  svg.rect(view.left, view.top, view.width(), view.height(), "fill:#e9d9c6");
  const bool shaded = scene.world && scene.world->height_m;
  if (shaded) {
    constexpr int kPixels = 400;
    const ReliefStyle style{1.0, 0.0, 0.0};
    svg.jpeg(view.left, view.top, view.width(), view.height(),
             relief_jpeg(scene.world->height_m, view.box, kPixels, kPixels, style));
  }
  draw_rocks(svg, view, scene, shaded ? RockStyle::kOutlined : RockStyle::kFilled);
  draw_cells(svg, view, incident.cells, kHazardCellM, fmt::format("fill:{};fill-opacity:.5", palette::kHazard));
  svg.polyline(view.px(incident.old_path), stroke("#3b2a1e", 4.2, "stroke-opacity:.5"));
  svg.polyline(view.px(incident.old_path), stroke(palette::kGlobalPath, 2.4, "stroke-dasharray:7 5"));
  svg.polyline(view.px(incident.new_path), stroke(palette::kRepair, 3.0));
  svg.polyline(view.px(true_line(scene)), stroke(palette::kTruth, 2.2));
  draw_footprint(svg, view, pose, scene.footprint,
                 fmt::format("fill:{0};fill-opacity:.18;stroke:{0};stroke-width:2", palette::kTruth));
  svg.end();
  svg.rect(view.left + 0.5, view.top, view.width() - 1.0, view.height() - 0.5, "fill:none;stroke:#5b4636");
  draw_scale_bar(svg, view, true_line(scene));
  return svg.str();
}

}  // namespace rover::report
