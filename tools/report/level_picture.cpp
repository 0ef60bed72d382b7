#include "tools/report/level_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/map_layers.hpp"
#include "tools/report/palette.hpp"
#include "tools/report/plot.hpp"

namespace rover::report {
namespace {

constexpr char kEfficient[] = "#1e88e5";
constexpr char kFull[] = "#d81b60";
constexpr double kSpeedWindowS = 60.0;
constexpr double kStripTop = 36.0;  // below the map
constexpr double kStrip = 130.0;
constexpr double kLine = 22.0;

const char* colour_of(bool full) {
  return full ? kFull : kEfficient;
}

struct Stretch {
  double from_s;
  double to_s;
  bool full;
};

std::vector<Stretch> stretches(const Scene& scene) {
  const Window& window = scene.evaluation.metrics.window;
  std::vector<Stretch> out;
  for (const StateChange& change : scene.run.states) {
    if (!out.empty()) out.back().to_s = std::clamp(change.t_s, window.begin_s, window.end_s);
    if (out.empty() || out.back().full != change.full)
      out.push_back({std::clamp(change.t_s, window.begin_s, window.end_s), window.end_s, change.full});
    else
      out.back().to_s = window.end_s;
  }
  return out;
}

Points true_line_between(const Scene& scene, double from_s, double to_s) {
  Points line;
  for (const TruthSample& sample : scene.run.truth)
    if (sample.t_s >= from_s && sample.t_s <= to_s) line.emplace_back(sample.T_map_body.translation().head<2>());
  return thinned(line, 0.05);
}

void draw_number(Svg& svg, const Eigen::Vector2d& at, size_t number, bool full) {
  svg.circle(at.x(), at.y(), 11.0, fmt::format("fill:#fff;stroke:{};stroke-width:2.4", colour_of(full)));
  svg.text(at.x(), at.y() + 4.5, std::to_string(number), 12.5, "font-weight:700", Anchor::kMiddle);
}

void draw_track(Svg& svg, const MapView& view, const Scene& scene, const TrueTrack& truth) {
  svg.polyline(view.px(true_line(scene)), stroke("#ffffff", 6.0, "stroke-opacity:.75"));
  for (const Stretch& stretch : stretches(scene))
    svg.polyline(view.px(true_line_between(scene, stretch.from_s, stretch.to_s)), stroke(colour_of(stretch.full), 3.4));
  for (const Incident& incident : scene.evaluation.incidents) {
    const Eigen::Vector2d p = view.px(Eigen::Vector2d(truth.at(incident.t_s).translation().head<2>()));
    svg.circle(p.x(), p.y(), 4.0,
               fmt::format("fill:{};stroke:#fff", incident.stopped ? palette::kBad : palette::kRepair));
  }
  const std::vector<LevelSwitch>& switches = scene.evaluation.metrics.level_switches;
  for (size_t i = 0; i < switches.size(); ++i) {
    const Eigen::Vector2d p = view.px(Eigen::Vector2d(truth.at(switches[i].t_s).translation().head<2>()));
    const Eigen::Vector2d off(0.0, i % 2 == 0 ? -26.0 : 26.0);
    svg.line(p.x(), p.y(), p.x(), p.y() + off.y(), stroke(palette::kInk, 1.2));
    draw_number(svg, p + off, i + 1, switches[i].to_full);
  }
}

// Distance driven within the last minute, over the distance driven.
Points effective_speed(const Scene& scene, const TrueTrack& truth) {
  constexpr double kStepS = 1.0;
  const Window& window = scene.evaluation.metrics.window;
  const double begin_m = truth.distance_m(window.begin_s);
  Points points;
  for (double t = window.begin_s + kStepS; t <= window.end_s; t += kStepS) {
    const double since = std::max(window.begin_s, t - kSpeedWindowS);
    points.emplace_back(truth.distance_m(t) - begin_m, (truth.distance_m(t) - truth.distance_m(since)) / (t - since));
  }
  return points;
}

// Speed over driven distance, above a band in the colours of the levels.
class Strip {
 public:
  Strip(const Scene& scene, const TrueTrack& truth, double left, double width, double top)
      : scene_(scene), truth_(truth), left_(left), width_(width), top_(top) {}

  void draw(Svg& svg) const {
    const Metrics& m = scene_.evaluation.metrics;
    for (const Stretch& stretch : stretches(scene_)) {
      const double from = x(m_at(stretch.from_s)), to = x(m_at(stretch.to_s));
      svg.rect(from, top_, std::max(to - from, 0.0), kStrip,
               fmt::format("fill:{};fill-opacity:.16", colour_of(stretch.full)));
    }
    draw_axis(svg);
    Points line;
    for (const Eigen::Vector2d& p : effective_speed(scene_, truth_)) line.push_back({x(p.x()), y(p.y())});
    svg.polyline(line, stroke(palette::kInk, 1.8, "fill:none"));
    for (const Incident& incident : scene_.evaluation.incidents)
      svg.line(x(m_at(incident.t_s)), top_ + kStrip - 12.0, x(m_at(incident.t_s)), top_ + kStrip,
               stroke(incident.stopped ? palette::kBad : palette::kRepair, 2.4));
    for (size_t i = 0; i < m.level_switches.size(); ++i)
      draw_number(svg, {x(m.level_switches[i].at_m), top_ + (i % 2 == 0 ? 14.0 : 38.0)}, i + 1,
                  m.level_switches[i].to_full);
  }

 private:
  double m_at(double t_s) const {
    return truth_.distance_m(t_s) - truth_.distance_m(scene_.evaluation.metrics.window.begin_s);
  }
  double x(double travelled_m) const {
    return left_ + width_ * travelled_m / std::max(1.0, scene_.evaluation.metrics.driven_length_m);
  }
  double y(double mps) const { return top_ + kStrip * (1.0 - mps / (1.15 * scene_.footprint.top_speed_mps)); }

  void draw_axis(Svg& svg) const {
    const std::string label = fmt::format("fill:{}", palette::kMuted);
    svg.text(left_, top_ - 10.0,
             "Effective speed over the last minute [m/s], stops (red) and repairs (violet), over driven distance", 14,
             "font-weight:600");
    for (double mps = 0.0; mps <= scene_.footprint.top_speed_mps + 1e-9; mps += 0.05) {
      svg.line(left_, y(mps), left_ + width_, y(mps), fmt::format("stroke:{};stroke-width:1", palette::kFaint));
      svg.text(left_ - 6.0, y(mps) + 4.0, fmt::format("{:.2f}", mps), 11.5, label, Anchor::kEnd);
    }
    const Axis ticks = round_axis(0.0, std::max(1.0, scene_.evaluation.metrics.driven_length_m), 10);
    for (double distance_m = 0.0; x(distance_m) <= left_ + width_ + 0.5; distance_m += ticks.step)
      svg.text(x(distance_m), top_ + kStrip + 16.0, number_text(distance_m), 11.5, label, Anchor::kMiddle);
  }

  const Scene& scene_;
  const TrueTrack& truth_;
  double left_;
  double width_;
  double top_;
};

void list_switches(Svg& svg, const Metrics& m, double left, double top) {
  double y = top;
  const auto legend = [&](double x, bool full, const LevelFigures& level) {
    svg.rect(left + x, y - 11.0, 14.0, 14.0, fmt::format("fill:{}", colour_of(full)));
    svg.text(left + x + 20.0, y,
             fmt::format("{}: {:.1f} m in {:.0f} s, {} hazard stops", full ? "FULL" : "EFFICIENT", level.travelled_m,
                         level.time_s, level.hazard_stops),
             13, "");
  };
  legend(0.0, false, m.efficient);
  legend(420.0, true, m.full);
  for (size_t i = 0; i < m.level_switches.size(); ++i) {
    y += kLine;
    const LevelSwitch& change = m.level_switches[i];
    svg.text(left, y,
             fmt::format("{}  at {:.1f} m, {:.0f} s: {}", i + 1, change.at_m,
                         std::max(0.0, change.t_s - m.window.begin_s), switch_text(change)),
             13, "");
  }
}

}  // namespace

std::string switch_text(const LevelSwitch& change) {
  std::string text = fmt::format("{}: {}", change.to_full ? "EFFICIENT to FULL" : "FULL to EFFICIENT", change.reason);
  if (!change.quantity.empty())
    text += fmt::format(", {} {:.2g}, threshold {:.2g}", change.quantity, change.value, change.threshold);
  return text;
}

std::string draw_levels(const Scene& scene) {
  const Metrics& m = scene.evaluation.metrics;
  const TrueTrack truth(scene.run.truth);
  if (truth.empty() || (m.level_switches.empty() && !(m.full.time_s > 0.0))) return {};
  const MapView view = map_view(scene);
  const double strip_top = view.top + view.height() + kMapAxis + kStripTop;
  const double list_top = strip_top + kStrip + 46.0;
  const double height = list_top + kLine * static_cast<double>(m.level_switches.size() + 1);
  Svg svg(kMapWidth, height);
  svg.rect(0.0, 0.0, kMapWidth, height, "fill:#fff");
  svg.begin_clip("levels-frame", view.left, view.top, view.width(), view.height());
  svg.rect(view.left, view.top, view.width(), view.height(), "fill:#e9d9c6");
  if (!scene.orbital.empty())
    svg.jpeg(view.left, view.top, view.width(), view.height(),
             relief_jpeg(scene.orbital, view.box, static_cast<int>(view.width()), static_cast<int>(view.height()),
                         ReliefStyle{}));
  svg.polyline(view.px(planned_line(scene)), stroke(palette::kGlobalPath, 2.0, "stroke-dasharray:9 6"));
  draw_track(svg, view, scene, truth);
  svg.end();
  draw_axes(svg, view);
  svg.rect(view.left, view.top, view.width(), view.height(), "fill:none;stroke:#5b4636;stroke-width:1.2");
  draw_scale_bar(svg, view, true_line(scene));
  draw_north(svg, view);
  Strip(scene, truth, view.left + 10.0, view.width() - 20.0, strip_top).draw(svg);
  list_switches(svg, m, view.left + 10.0, list_top);
  return svg.str();
}

}  // namespace rover::report
