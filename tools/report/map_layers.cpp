#include "tools/report/map_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/report/palette.hpp"

namespace rover::report {
namespace {

constexpr double kPebbleM = 0.08;  // minimum height of drawn rocks

std::string circle_path(const Eigen::Vector2d& c, double r) {
  const std::string radius = number_text(r, 1);
  const std::string across = number_text(2.0 * r, 1);
  return fmt::format("M{} {}a{} {} 0 1 0 {} 0a{} {} 0 1 0 -{} 0z", number_text(c.x() - r, 1), number_text(c.y(), 1),
                     radius, radius, across, radius, radius, across);
}

// 1, 2 or 5 times a power of ten, at most `limit`.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= limit) return factor * power;
  return power;
}

}  // namespace

MapView map_view(const Scene& scene) {
  const Box lines = bounds({true_line(scene), planned_line(scene)});
  const double margin = std::max(3.0, 0.06 * std::max(lines.width_m(), lines.height_m()));
  MapView view;
  view.box = with_aspect(lines.expanded(margin), 0.36, 0.95);
  view.left = kMapAxis + 8.0;
  view.top = 8.0;
  view.px_per_m = (kMapWidth - view.left - 8.0) / view.box.width_m();
  return view;
}

void draw_axes(Svg& svg, const MapView& view) {
  const double step = view.box.width_m() > 60.0 ? 10.0 : 5.0;
  const std::string style = fmt::format("fill:{}", palette::kMuted);
  const std::string grid = "stroke:#5b4636;stroke-opacity:.16;stroke-width:1";
  for (double x = std::ceil(view.box.x0_m / step) * step; x <= view.box.x1_m; x += step) {
    const double u = view.px(Eigen::Vector2d(x, 0.0)).x();
    svg.line(u, view.top, u, view.top + view.height(), grid);
    svg.text(u, view.top + view.height() + 17.0, number_text(x), 12, style, Anchor::kMiddle);
  }
  for (double y = std::ceil(view.box.y0_m / step) * step; y <= view.box.y1_m; y += step) {
    const double v = view.px(Eigen::Vector2d(0.0, y)).y();
    svg.line(view.left, v, view.left + view.width(), v, grid);
    svg.text(view.left - 6.0, v + 4.0, number_text(y), 12, style, Anchor::kEnd);
  }
  svg.text(view.left + view.width(), view.top + view.height() + 31.0, "x east, y north in the map frame [m]", 12, style,
           Anchor::kEnd);
}

std::string stroke(const char* colour, double width, const std::string& more) {
  return fmt::format("stroke:{};stroke-width:{};stroke-linejoin:round;stroke-linecap:round;{}", colour, width, more);
}

Points MapView::px(const Points& line) const {
  Points out;
  for (const Eigen::Vector2d& p : line) out.push_back(px(p));
  return out;
}

Box bounds(const std::vector<Points>& lines) {
  Box box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const Points& line : lines)
    for (const Eigen::Vector2d& p : line) {
      box.x0_m = std::min(box.x0_m, p.x());
      box.y0_m = std::min(box.y0_m, p.y());
      box.x1_m = std::max(box.x1_m, p.x());
      box.y1_m = std::max(box.y1_m, p.y());
    }
  return box.x0_m <= box.x1_m ? box : Box{0.0, 0.0, 1.0, 1.0};
}

Box with_aspect(Box box, double min_ratio, double max_ratio) {
  const double grow_y = 0.5 * std::max(0.0, min_ratio * box.width_m() - box.height_m());
  const double grow_x = 0.5 * std::max(0.0, box.height_m() / max_ratio - box.width_m());
  return {box.x0_m - grow_x, box.y0_m - grow_y, box.x1_m + grow_x, box.y1_m + grow_y};
}

void draw_rocks(Svg& svg, const MapView& view, const Scene& scene, RockStyle style) {
  if (!scene.world) return;
  std::string pebbles;
  std::string hazards;
  for (const Rock& rock : scene.world->rocks) {
    const Eigen::Vector2d p(rock.x_m, rock.y_m);
    if (rock.height_m < kPebbleM || !view.box.expanded(rock.radius_m).contains(p)) continue;
    (rock.height_m >= kHazardRockM ? hazards : pebbles) += circle_path(view.px(p), rock.radius_m * view.px_per_m);
  }
  if (style == RockStyle::kFilled) {
    svg.path(pebbles, fmt::format("fill:{};fill-opacity:.28", palette::kPebble));
    svg.path(hazards, fmt::format("fill:{};stroke:#fff;stroke-width:.6", palette::kRock));
  } else {
    svg.path(hazards, fmt::format("fill:{0};fill-opacity:.3;stroke:{0};stroke-width:1.6", palette::kRock));
  }
  for (const RockResult& result : scene.evaluation.rocks) {
    const Eigen::Vector2d p(result.rock.x_m, result.rock.y_m);
    if (!result.missed() || !view.box.contains(p)) continue;
    const Eigen::Vector2d c = view.px(p);
    svg.circle(c.x(), c.y(), result.rock.radius_m * view.px_per_m + 5.0,
               fmt::format("fill:none;stroke:{};stroke-width:3", palette::kBad));
  }
}

void draw_cells(Svg& svg, const MapView& view, const Points& cells, double cell_m, const std::string& style) {
  std::set<std::pair<int, int>> lattice;  // row, column: adjacent cells of a row become one rectangle
  for (const Eigen::Vector2d& p : cells)
    if (view.box.contains(p))
      lattice.emplace(static_cast<int>(std::floor(p.y() / cell_m)), static_cast<int>(std::floor(p.x() / cell_m)));
  std::string path;
  for (auto it = lattice.begin(); it != lattice.end();) {
    const auto [row, first] = *it;
    int last = first;
    while (++it != lattice.end() && it->first == row && it->second == last + 1) ++last;
    const Eigen::Vector2d corner = view.px(Eigen::Vector2d(first * cell_m, (row + 1) * cell_m));
    const std::string width = number_text((last - first + 1) * cell_m * view.px_per_m);
    path += fmt::format("M{} {}h{}v{}h-{}z", number_text(corner.x(), 1), number_text(corner.y(), 1), width,
                        number_text(cell_m * view.px_per_m), width);
  }
  if (!path.empty()) svg.path(path, style);
}

void draw_footprint(Svg& svg, const MapView& view, const Pose2& pose, const Footprint& footprint,
                    const std::string& style) {
  const double l = footprint.half_length_m;
  const double w = footprint.half_width_m;
  Points outline;
  for (const Eigen::Vector2d& corner : Points{{l, w}, {-l, w}, {-l, -w}, {l, -w}})
    outline.push_back(view.px(transform(pose, corner)));
  svg.polygon(outline, style);
  Points nose;
  for (const Eigen::Vector2d& corner : Points{{l - 0.35, 0.6 * w}, {l - 0.05, 0.0}, {l - 0.35, -0.6 * w}})
    nose.push_back(view.px(transform(pose, corner)));
  svg.polyline(nose, style + ";fill:none");
}

void draw_scale_bar(Svg& svg, const MapView& view, const Points& line) {
  const double length = round_length(0.22 * view.box.width_m());
  const double w = length * view.px_per_m;
  const double y = view.top + view.height() - 24.0;
  const double left = view.left + 22.0;
  const double right = view.left + view.width() - 22.0 - w;
  const auto room = [&](double x) {
    double least = kInfinity;
    for (const Eigen::Vector2d& p : view.px(line))
      least = std::min(least, (p - Eigen::Vector2d(x + 0.5 * w, y)).norm());
    return least;
  };
  const double x = room(left) >= room(right) ? left : right;
  svg.rect(x - 12.0, y - 24.0, w + 24.0, 38.0, "fill:#fff;fill-opacity:.82", 5.0);
  svg.rect(x, y - 2.0, 0.5 * w, 5.0, fmt::format("fill:{}", palette::kInk));
  svg.rect(x + 0.5 * w, y - 2.0, 0.5 * w, 5.0, fmt::format("fill:#fff;stroke:{}", palette::kInk));
  svg.text(x + 0.5 * w, y - 8.0, number_text(length) + " m", 13, "font-weight:600", Anchor::kMiddle);
}

void draw_north(Svg& svg, const MapView& view) {
  const double x = view.left + view.width() - 34.0;
  const double y = view.top + 44.0;
  svg.circle(x, y, 25.0, "fill:#fff;fill-opacity:.82");
  svg.polygon({{x, y - 19.0}, {x + 7.0, y + 5.0}, {x, y}, {x - 7.0, y + 5.0}}, fmt::format("fill:{}", palette::kInk));
  svg.text(x, y + 19.0, "N", 13, "font-weight:700", Anchor::kMiddle);
}

std::string incident_title(const Scene& scene, size_t index) {
  const Incident& incident = scene.evaluation.incidents[index];
  std::string title = incident.stopped ? "stop" : "repair while driving";
  if (incident.stopped && incident.replanned) title = "stop and repair";
  if (incident.unseen) return title + ", unobserved ground";
  if (!scene.world) return title;
  if (incident.tallest_rock_m >= kRealRockM)
    return title + fmt::format(", rock {:.2f} m tall", incident.tallest_rock_m);
  return title + (incident.real ? ", step or hole" : ", false detection");
}

}  // namespace rover::report
