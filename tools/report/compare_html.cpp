#include "tools/report/compare_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/report/html_parts.hpp"
#include "tools/report/no_truth.hpp"
#include "tools/report/svg.hpp"

namespace rover::report {
namespace {

enum class Better { kLower, kHigher, kNeither };

struct FigureText {
  const char* what;
  const char* unit;
  int decimals;
  Better better;
};

struct Figure {
  FigureText text;
  double (*of)(const Metrics& m);
};

double known(const std::optional<int>& value) {
  return value ? *value : kNaN;
}

// The metrics by which an operator compares two runs.
const Figure kFigures[] = {
    {"Planned path", "m", 1, Better::kNeither, [](const Metrics& m) { return m.planned_length_m; }},
    {"Driven", "m", 1, Better::kNeither, [](const Metrics& m) { return m.driven_length_m; }},
    {"Driven / planned", "", 3, Better::kLower, [](const Metrics& m) { return m.path_ratio; }},
    {"Shortest drivable path", "m", 1, Better::kNeither, [](const Metrics& m) { return m.oracle_m; }},
    {"Regret: driven / shortest drivable", "", 3, Better::kLower, [](const Metrics& m) { return m.regret; }},
    {"Duration of the drive", "s", 0, Better::kLower, [](const Metrics& m) { return m.duration_s; }},
    {"Progress: planned / (0.2 m/s x time)", "%", 1, Better::kHigher,
     [](const Metrics& m) { return 100.0 * m.progress; }},
    {"Duty: driven / (0.2 m/s x time)", "%", 1, Better::kHigher, [](const Metrics& m) { return 100.0 * m.duty; }},
    {"Driven in reverse", "m", 1, Better::kLower, [](const Metrics& m) { return m.reverse_m; }},
    {"Repairs", "", 0, Better::kLower, [](const Metrics& m) { return 1.0 * m.replans; }},
    {"Hazard stops", "", 0, Better::kLower, [](const Metrics& m) { return 1.0 * m.hazard_stops; }},
    {"False stops or repairs", "", 0, Better::kLower, [](const Metrics& m) { return known(m.false_stops); }},
    {"Collisions", "", 0, Better::kLower, [](const Metrics& m) { return has_truth(m) ? 1.0 * m.collisions : kNaN; }},
    {"Minimum clearance", "m", 2, Better::kHigher, [](const Metrics& m) { return m.min_clearance_m; }},
    {"Closest approach of a wheel to a hazard", "m", 2, Better::kHigher,
     [](const Metrics& m) { return m.hazard_clearance_m; }},
    {"Rocks encountered", "", 0, Better::kNeither, [](const Metrics& m) { return known(m.rocks_encountered); }},
    {"Rocks missed", "", 0, Better::kLower, [](const Metrics& m) { return known(m.rocks_missed); }},
    {"Cross-track error, rms", "m", 3, Better::kLower, [](const Metrics& m) { return m.cross_track_rms_m; }},
    {"Cross-track error, maximum", "m", 3, Better::kLower, [](const Metrics& m) { return m.cross_track_max_m; }},
    {"True distance from the followed path, maximum", "m", 3, Better::kLower,
     [](const Metrics& m) { return m.truth_deviation_max_m; }},
    {"Odometry drift", "%", 2, Better::kLower, [](const Metrics& m) { return m.odometry_drift_percent; }},
    {"True distance to the goal", "m", 2, Better::kLower, [](const Metrics& m) { return m.final_error_m; }},
    {"Roll, maximum", "deg", 1, Better::kLower, [](const Metrics& m) { return m.max_roll_deg; }},
    {"Pitch, maximum", "deg", 1, Better::kLower, [](const Metrics& m) { return m.max_pitch_deg; }},
    {"Wheel slip, mean", "%", 1, Better::kLower, [](const Metrics& m) { return 100.0 * m.mean_slip; }},
    {"Drive current, mean", "A", 2, Better::kLower, [](const Metrics& m) { return m.mean_abs_current_a; }},
    {"Faults raised", "", 0, Better::kLower, [](const Metrics& m) { return 1.0 * static_cast<double>(m.fdir.size()); }},
    {"Bus messages lost", "", 0, Better::kLower, [](const Metrics& m) { return static_cast<double>(m.bus_lost); }},
    {"Times real time", "", 2, Better::kHigher, [](const Metrics& m) { return m.realtime_factor; }},
};

const char* mark(Better better, double mine, double other) {
  if (better == Better::kNeither || !std::isfinite(mine) || !std::isfinite(other) || mine == other) return "";
  return (mine < other) == (better == Better::kLower) ? " better" : "";
}

// Equal when both print the same digits.
std::string figure_row(const FigureText& figure, double of_a, double of_b) {
  const std::string text_a = shown(of_a, figure.decimals, figure.unit);
  const std::string text_b = shown(of_b, figure.decimals, figure.unit);
  const bool same = text_a == text_b;
  const bool both = std::isfinite(of_a) && std::isfinite(of_b);
  const std::string change = same ? "=" : both ? fmt::format("{:+.{}f}", of_b - of_a, figure.decimals) : "";
  return fmt::format("<tr><td>{}</td><td class=\"n{}\">{}</td><td class=\"n{}\">{}</td><td class=\"n\">{}</td></tr>\n",
                     figure.what, same ? "" : mark(figure.better, of_a, of_b), text_a,
                     same ? "" : mark(figure.better, of_b, of_a), text_b, change);
}

// Seconds by cause, without those that neither run has.
std::string time_rows(const TimeAccount& a, const TimeAccount& b) {
  std::string out;
  for (int i = 0; i < kTimeCauses; ++i) {
    const auto cause = static_cast<TimeCause>(i);
    const std::string what = fmt::format("Time: {}", title_of(cause));
    const bool travels = cause == TimeCause::kStraight || cause == TimeCause::kCurve;
    if (a.of(cause) > 0.0 || b.of(cause) > 0.0)
      out += figure_row({what.c_str(), "s", 1, travels ? Better::kNeither : Better::kLower}, a.of(cause), b.of(cause));
  }
  return out;
}

std::string heading(const ComparedRun& run) {
  return fmt::format(
      "<div><h2>{}</h2><div class=\"meta\">{} &middot; {}</div><p><span class=\"badge {}\">{}</span></p>{}</div>\n",
      escaped(run.name), escaped(run.metrics.info.scenario), run_facts(run.metrics.info),
      run.metrics.outcome == "goal_reached" ? "good" : "bad", escaped(outcome_text(run.metrics.outcome)),
      remarks(run.metrics));
}

std::string figures_section(const ComparedRun& a, const ComparedRun& b) {
  std::string out = fmt::format(
      "<h2>Metrics</h2><table><tr><th></th><th class=\"n\">A: {}</th><th class=\"n\">B: {}</th><th class=\"n\">B - "
      "A</th></tr>\n",
      escaped(a.name), escaped(b.name));
  for (const Figure& figure : kFigures) out += figure_row(figure.text, figure.of(a.metrics), figure.of(b.metrics));
  return out + time_rows(a.metrics.time, b.metrics.time) + "</table>\n";
}

std::string service_cells(const Metrics& m, const std::string& name) {
  const auto it = m.services.find(name);
  if (it == m.services.end()) return "<td class=\"n\">n/a</td><td class=\"n\">n/a</td><td class=\"n\">n/a</td>";
  const ServiceFigures& s = it->second;
  return fmt::format("<td class=\"n\">{}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.0f}</td>",
                     shown(s.cpu_s_per_m, 3), s.p99_ms, s.rss_mb);
}

std::string compared_services(const ComparedRun& a, const ComparedRun& b) {
  std::set<std::string> names;
  for (const ComparedRun* run : {&a, &b})
    for (const auto& [name, service] : run->metrics.services) names.insert(name);
  std::string out =
      "<h2>Services</h2><table><tr><th></th><th class=\"n\">A: CPU [s/m]</th><th class=\"n\">p99 [ms]</th><th "
      "class=\"n\">memory [MB]</th><th class=\"n\">B: CPU [s/m]</th><th class=\"n\">p99 [ms]</th><th "
      "class=\"n\">memory [MB]</th></tr>\n";
  for (const std::string& name : names)
    out += fmt::format("<tr><td>{}</td>{}{}</tr>\n", escaped(name), service_cells(a.metrics, name),
                       service_cells(b.metrics, name));
  return out + "</table>\n";
}

// Do not list the points of long paths.
std::string shortened(const std::string& text) {
  constexpr size_t kMaxLength = 90;
  return text.size() <= kMaxLength ? text
                                   : fmt::format("{} ... ({} characters)", text.substr(0, kMaxLength), text.size());
}

std::string differences_section(const std::vector<ConfigDifference>& differences) {
  if (differences.empty()) return "<h2>Configuration</h2><p>No differences.</p>\n";
  std::string out =
      "<h2>Configuration differences</h2><table class=\"thirds\"><tr><th>file: key</th><th>A</th><th>B</th></tr>\n";
  for (const ConfigDifference& d : differences)
    out += fmt::format("<tr><td>{}</td><td><code>{}</code></td><td><code>{}</code></td></tr>\n", escaped(d.key),
                       escaped(shortened(d.a)), escaped(shortened(d.b)));
  return out + "</table>\n";
}

// Ids within one HTML document must be unique.
std::string renamed(std::string svg, const std::string& prefix) {
  for (const std::string& before : {std::string("clipPath id=\""), std::string("url(#")})
    for (size_t at = svg.find(before); at != std::string::npos; at = svg.find(before, at + before.size()))
      svg.insert(at + before.size(), prefix);
  return svg;
}

std::string pair(const std::string& of_a, const std::string& of_b) {
  return "<div class=\"pair\"><div>" + renamed(of_a, "a-") + "</div><div>" + renamed(of_b, "b-") + "</div></div>\n";
}

}  // namespace

std::string compare_html(const ComparedRun& a, const ComparedRun& b,
                         const std::vector<ConfigDifference>& configuration) {
  std::string body = "<h1>Comparison of two runs</h1><div class=\"pair\">" + heading(a) + heading(b) + "</div>\n";
  body += layered_maps(pair(a.pictures.map, b.pictures.map));
  body += figures_section(a, b) + compared_services(a, b);
  body += "<h2>Over driven distance [m]</h2><section class=\"plots\">\n";
  for (size_t i = 0; i < std::min(a.pictures.plots.size(), b.pictures.plots.size()); ++i)
    body += pair(a.pictures.plots[i], b.pictures.plots[i]);
  body += pair(a.pictures.states, b.pictures.states) + "</section>\n" + differences_section(configuration);
  return document("Compared: " + a.name + ", " + b.name, body);
}

}  // namespace rover::report
