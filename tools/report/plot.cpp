#include "tools/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"
#include "tools/report/palette.hpp"

namespace rover::report {
namespace {

constexpr double kWidth = 1100.0;
constexpr double kLeft = 58.0;
constexpr double kRight = 14.0;
constexpr double kTop = 34.0;
constexpr double kHeight = 132.0;  // of the field
constexpr double kBottom = 22.0;
constexpr int kColumns = 700;
constexpr double kFlat = 1e-9;

Axis value_axis(const Plot& plot) {
  double low = kInfinity;
  double high = -kInfinity;
  const auto include = [&](double y) {
    if (!std::isfinite(y)) return;
    low = std::min(low, y);
    high = std::max(high, y);
  };
  for (const Series& series : plot.series)
    for (const Eigen::Vector2d& p : series.points) include(p.y());
  for (const double limit : plot.limits) include(limit);
  if (plot.from_zero) include(0.0);
  // Differences at rounding level are a flat line; axis steps between them would be too small.
  if (low <= high && high - low < kFlat) low = high = std::abs(high) < kFlat ? 0.0 : high;
  return low <= high ? round_axis(low, high, 4) : Axis{};
}

struct Field {
  Axis x;
  Axis y;
  double px_x(double v) const { return kLeft + (v - x.low) / (x.high - x.low) * (kWidth - kLeft - kRight); }
  double px_y(double v) const { return kTop + (y.high - v) / (y.high - y.low) * kHeight; }
};

void draw_grid(Svg& svg, const Field& field, const Plot& plot) {
  const std::string label = fmt::format("fill:{}", palette::kMuted);
  const std::string grid = fmt::format("stroke:{};stroke-width:1", palette::kFaint);
  for (double v = field.y.low; v <= field.y.high + 1e-9; v += field.y.step) {
    svg.line(kLeft, field.px_y(v), kWidth - kRight, field.px_y(v), grid);
    const int decimals = static_cast<int>(std::max(0.0, std::ceil(-std::log10(field.y.step) - 1e-9)));
    svg.text(kLeft - 7.0, field.px_y(v) + 4.0, fmt::format("{:.{}f}", std::abs(v) < 1e-12 ? 0.0 : v, decimals), 11.5,
             label, Anchor::kEnd);
  }
  const Axis ticks = round_axis(field.x.low, field.x.high, 10);
  for (double v = 0.0; v <= field.x.high + 1e-9; v += ticks.step)
    svg.text(field.px_x(v), kTop + kHeight + 17.0, number_text(v), 11.5, label, Anchor::kMiddle);
  svg.text(kLeft, 16.0, plot.title + " [" + plot.unit + "]", 14, "font-weight:600");
}

void draw_marks(Svg& svg, const Field& field, const PlotMarks& marks) {
  for (size_t i = 0; i < marks.at_m.size(); ++i) {
    const double x = field.px_x(marks.at_m[i]);
    svg.line(x, kTop, x, kTop + kHeight, fmt::format("stroke:{};stroke-width:1;stroke-opacity:.45", marks.colours[i]));
    svg.text(x, kTop - 3.0, std::to_string(i + 1), 10, fmt::format("fill:{}", marks.colours[i]), Anchor::kMiddle);
  }
}

void draw_names(Svg& svg, const Plot& plot) {
  double x = kWidth - kRight;
  for (auto it = plot.series.rbegin(); it != plot.series.rend(); ++it) {
    if (it->name.empty()) continue;
    svg.text(x, 16.0, it->name, 12, "", Anchor::kEnd);
    x -= 7.2 * static_cast<double>(it->name.size()) + 8.0;
    svg.line(x - 18.0, 12.0, x, 12.0, fmt::format("stroke:{};stroke-width:3", it->colour));
    x -= 34.0;
  }
}

void draw_series(Svg& svg, const Field& field, const Series& series) {
  Points part;
  const std::string style = fmt::format("stroke:{};stroke-width:{};stroke-linejoin:round{}", series.colour,
                                        series.width, series.dashed ? ";stroke-dasharray:5 4" : "");
  const auto flush = [&] {
    if (part.size() > 1) svg.polyline(part, style);
    part.clear();
  };
  for (const Eigen::Vector2d& p : envelope(series.points, field.x.low, field.x.high, kColumns)) {
    if (std::isfinite(p.y())) {
      part.emplace_back(field.px_x(p.x()), field.px_y(p.y()));
    } else {
      flush();
    }
  }
  flush();
}

}  // namespace

Axis round_axis(double low, double high, int count) {
  if (!(high > low)) {
    const double around = low == 0.0 ? 1.0 : std::abs(low) * 0.5;
    return round_axis(low - around, low + around, count);
  }
  const double raw = (high - low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= raw) step = factor * power;
  return {std::floor(low / step) * step, std::ceil(high / step) * step, step};
}

Points envelope(const Points& points, double x_low, double x_high, int columns) {
  Points thin;
  const auto column_of = [&](const Eigen::Vector2d& p) {
    return static_cast<int>((p.x() - x_low) / (x_high - x_low) * columns);
  };
  for (size_t i = 0; i < points.size();) {
    if (!std::isfinite(points[i].y())) {
      thin.push_back(points[i++]);
      continue;
    }
    const int column = column_of(points[i]);
    size_t low = i;
    size_t high = i;
    for (; i < points.size() && std::isfinite(points[i].y()) && column_of(points[i]) == column; ++i) {
      if (points[i].y() < points[low].y()) low = i;
      if (points[i].y() > points[high].y()) high = i;
    }
    thin.push_back(points[std::min(low, high)]);
    if (low != high) thin.push_back(points[std::max(low, high)]);
  }
  return thin;
}

std::string draw_plot(const Plot& plot, const PlotMarks& marks, double distance_m, const std::string& id) {
  Svg svg(kWidth, kTop + kHeight + kBottom);
  const Field field{{0.0, std::max(distance_m, 0.1), 1.0}, value_axis(plot)};
  draw_grid(svg, field, plot);
  draw_names(svg, plot);
  svg.begin_clip(id, kLeft, kTop - 1.0, kWidth - kLeft - kRight, kHeight + 2.0);
  for (const double limit : plot.limits)
    svg.line(kLeft, field.px_y(limit), kWidth - kRight, field.px_y(limit),
             fmt::format("stroke:{};stroke-width:1.2;stroke-dasharray:7 5", palette::kBad));
  for (const Series& series : plot.series) draw_series(svg, field, series);
  svg.end();
  draw_marks(svg, field, marks);
  return svg.str();
}

}  // namespace rover::report
