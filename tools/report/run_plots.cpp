#include "tools/report/run_plots.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "tools/report/no_truth.hpp"
#include "tools/report/palette.hpp"

namespace rover::report {
namespace {

// Distance since the start of the drive, for samples within the drive.
class DistanceAxis {
 public:
  explicit DistanceAxis(const Scene& scene)
      : truth_(scene.run.truth),
        window_(scene.evaluation.metrics.window),
        begin_m_(truth_.distance_m(window_.begin_s)) {}
  bool contains(double t_s) const { return window_.contains(t_s); }
  double at(double t_s) const { return truth_.distance_m(t_s) - begin_m_; }
  const TrueTrack& truth() const { return truth_; }
  const Window& window() const { return window_; }

 private:
  TrueTrack truth_;
  Window window_;
  double begin_m_;
};

template <class Sample, class Value>
Points points_of(const std::vector<Sample>& samples, const DistanceAxis& axis, Value value) {
  Points points;
  for (const Sample& sample : samples)
    if (axis.contains(sample.t_s)) points.emplace_back(axis.at(sample.t_s), value(sample));
  return points;
}

Plot cross_track_plot(const Scene& scene, const DistanceAxis& axis) {
  const auto value = [](const ControlSample& c) {
    return c.following == Following::kFollowing ? c.cross_track_m : kNaN;
  };
  return {"Cross-track error",
          "m",
          {{"", palette::kTruth, 1.6, false, points_of(scene.run.control, axis, value)}},
          {},
          true};
}

Plot drift_plot(const Scene& scene, const DistanceAxis& axis) {
  const std::vector<DriftSample> drift = odometry_drift(scene.run, axis.truth(), axis.window());
  const auto line = [&](auto value) {
    Points points;
    for (const DriftSample& sample : drift) points.emplace_back(sample.distance_m, value(sample));
    return points;
  };
  return {"Odometry drift",
          "m",
          {{"x", palette::kWheels[2], 1.4, false, line([](const DriftSample& s) { return s.error_x_m; })},
           {"y", palette::kWheels[3], 1.4, false, line([](const DriftSample& s) { return s.error_y_m; })},
           {"distance", palette::kInk, 1.8, false,
            line([](const DriftSample& s) { return std::hypot(s.error_x_m, s.error_y_m); })}},
          {},
          true};
}

Plot drift_percent_plot(const Scene& scene, const DistanceAxis& axis) {
  constexpr double kFromM = 2.0;  // minimum distance for a meaningful ratio
  Points points;
  for (const DriftSample& s : odometry_drift(scene.run, axis.truth(), axis.window()))
    if (s.distance_m >= kFromM)
      points.emplace_back(s.distance_m, 100.0 * std::hypot(s.error_x_m, s.error_y_m) / s.distance_m);
  return {"Odometry drift over distance driven", "%", {{"", palette::kInk, 1.8, false, points}}, {}, true};
}

Plot attitude_plot(const Scene& scene, const DistanceAxis& axis) {
  const auto rpy = [](const TruthSample& t) { return rpy_of(t.T_map_body.linear()); };
  return {"Attitude",
          "deg",
          {{"roll", palette::kWheels[2], 1.4, false,
            points_of(scene.run.truth, axis, [&](const TruthSample& t) { return to_deg(rpy(t).x()); })},
           {"pitch, nose down", palette::kWheels[3], 1.4, false,
            points_of(scene.run.truth, axis, [&](const TruthSample& t) { return to_deg(rpy(t).y()); })}},
          {},
          true};
}

Plot slip_plot(const Scene& scene, const DistanceAxis& axis) {
  // Exclude wheels at rest and in transients: slip is undefined or useless there.
  const auto moving = [](const TruthSample& t) { return t.speed_mps > 0.03 ? 100.0 * t.wheel_slip : kNaN; };
  return {"Slip",
          "%",
          {{"true, mean of the wheels", palette::kTruth, 1.2, false, points_of(scene.run.truth, axis, moving)},
           {"estimated", palette::kEstimate, 1.8, false,
            points_of(scene.run.slip, axis, [](const SlipSample& s) { return 100.0 * s.slip_ratio; })}},
          {},
          true};
}

Plot current_plot(const Scene& scene, const DistanceAxis& axis) {
  static const std::array<const char*, 6> kNames = {"FL", "FR", "ML", "MR", "RL", "RR"};
  Plot plot{"Drive currents", "A", {}, {}, true};
  for (size_t wheel = 0; wheel < 6; ++wheel)
    plot.series.push_back(
        {kNames[wheel], palette::kWheels[wheel], 1.1, false,
         points_of(scene.run.wheels, axis, [wheel](const WheelSample& w) { return w.current_a[wheel]; })});
  return plot;
}

Plot speed_plot(const Scene& scene, const DistanceAxis& axis) {
  return {"Speed",
          "m/s",
          {{"", palette::kTruth, 1.4, false,
            points_of(scene.run.truth, axis, [](const TruthSample& t) { return t.speed_mps; })}},
          {scene.footprint.top_speed_mps},
          true};
}

const char* state_colour(State state) {
  switch (state) {
    case State::kDriving:
      return "#2e7d5b";
    case State::kHazardStop:
      return "#d84315";
    case State::kRepairing:
      return palette::kRepair;
    case State::kGoalReached:
      return "#0b5fa5";
    case State::kFaultStop:
    case State::kSafe:
      return palette::kBad;
    default:
      return "#b0b8bf";
  }
}

}  // namespace

std::vector<Plot> run_plots(const Scene& scene) {
  const DistanceAxis axis(scene);
  std::vector<Plot> plots{cross_track_plot(scene, axis)};
  if (has_truth(scene.evaluation.metrics)) {
    plots.push_back(drift_plot(scene, axis));
    plots.push_back(drift_percent_plot(scene, axis));
  }
  for (const auto& plot : {attitude_plot, slip_plot, current_plot, speed_plot}) plots.push_back(plot(scene, axis));
  return plots;
}

PlotMarks incident_marks(const Scene& scene) {
  const DistanceAxis axis(scene);
  PlotMarks marks;
  for (const Incident& incident : scene.evaluation.incidents) {
    marks.at_m.push_back(axis.at(incident.t_s));
    marks.colours.push_back(incident.stopped ? palette::kBad : palette::kRepair);
  }
  return marks;
}

std::string draw_state_timeline(const Scene& scene) {
  constexpr double kWidth = 1100.0;
  constexpr double kLeft = 58.0;  // as the plots
  constexpr double kRight = 1086.0;
  constexpr double kBandTop = 26.0;
  constexpr double kBand = 30.0;
  Svg svg(kWidth, 112.0);
  const std::vector<StateChange>& states = scene.run.states;
  const double end_s = std::max(scene.evaluation.metrics.window.end_s + 1.0, states.empty() ? 1.0 : states.back().t_s);
  const double begin_s = states.empty() ? 0.0 : std::min(states.front().t_s, scene.evaluation.metrics.window.begin_s);
  const auto px = [&](double t) {
    return (std::min(t, end_s) - begin_s) / (end_s - begin_s) * (kRight - kLeft) + kLeft;
  };
  svg.text(kLeft, 15.0, "States of the supervisor, by time since the start of the drive [s]", 14, "font-weight:600");
  std::map<State, double> spent;
  for (size_t i = 0; i < states.size(); ++i) {
    const double from = px(states[i].t_s);
    const double to = px(i + 1 < states.size() ? states[i + 1].t_s : end_s);
    svg.rect(from, kBandTop, std::max(to - from, 0.6), kBand, fmt::format("fill:{}", state_colour(states[i].state)));
    spent[states[i].state] += (i + 1 < states.size() ? states[i + 1].t_s : end_s) - states[i].t_s;
  }
  const std::string label = fmt::format("fill:{}", palette::kMuted);
  const double start_s = scene.evaluation.metrics.window.begin_s;
  const Axis ticks = round_axis(0.0, end_s - start_s, 10);
  for (double t = 0.0; t <= end_s - start_s; t += ticks.step)
    svg.text(px(start_s + t), kBandTop + kBand + 16.0, number_text(t), 11.5, label, Anchor::kMiddle);
  double x = kLeft;
  for (const auto& [state, seconds] : spent) {
    const std::string text = fmt::format("{} {:.0f} s", state_name(state), seconds);
    svg.rect(x, 92.0, 12.0, 12.0, fmt::format("fill:{}", state_colour(state)), 2.0);
    svg.text(x + 18.0, 102.5, text, 12, "");
    x += 8.0 * static_cast<double>(text.size()) + 34.0;
  }
  return svg.str();
}

}  // namespace rover::report
