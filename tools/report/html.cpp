#include "tools/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/fidelity_section.hpp"
#include "tools/report/html_parts.hpp"
#include "tools/report/map_layers.hpp"
#include "tools/report/no_truth.hpp"
#include "tools/report/svg.hpp"
#include "tools/report/time_section.hpp"
#include "tools/report/trajectory_section.hpp"

namespace rover::report {
namespace {

std::string header(const Metrics& m) {
  const char* whose = has_truth(m) ? "" : " &middot; no ground truth: evaluated with the rover's own estimate";
  return fmt::format(
      "<header><div><h1>Traverse: {}</h1><div class=\"meta\">{}</div></div>"
      "<div class=\"badge {}\">{}</div></header>\n",
      escaped(m.info.scenario), run_facts(m.info) + whose, m.outcome == "goal_reached" ? "good" : "bad",
      escaped(outcome_text(m.outcome)));
}

std::string card(const std::string& value, const std::string& what, const std::string& kind = "") {
  return fmt::format("<div class=\"card {}\"><b>{}</b><span>{}</span></div>\n", kind, value, what);
}

std::string cards(const Metrics& m) {
  std::string out = "<section class=\"cards\">\n";
  out += card(shown(m.driven_length_m, 1, "m"), fmt::format("driven, {} planned", shown(m.planned_length_m, 1, "m")));
  out +=
      card(shown(m.path_ratio, 3), fmt::format("driven / planned; driven / shortest drivable {}", shown(m.regret, 3)));
  out +=
      card(shown(100.0 * m.progress, 0, "%"),
           fmt::format("progress; {}, duty {}", shown(m.mean_speed_m_per_h, 0, "m/h"), shown(100.0 * m.duty, 0, "%")));
  out += card(shown(m.duration_s, 0, "s"), fmt::format("{} times real time", shown(m.realtime_factor, 1)));
  out += card(std::to_string(m.replans), fmt::format("repairs; hazard stops: {}", m.hazard_stops));
  out += card(has_truth(m) ? std::to_string(m.collisions) : "n/a",
              fmt::format("collisions, minimum clearance {}", shown(m.min_clearance_m, 2, "m")),
              verdict(has_truth(m), m.collisions == 0));
  out += card(shown(m.rocks_missed), fmt::format("rocks missed of {} encountered", shown(m.rocks_encountered)),
              verdict(m.rocks_missed.has_value(), m.rocks_missed == 0));
  out += card(shown(m.false_stops), "false stops or repairs", verdict(m.false_stops.has_value(), m.false_stops == 0));
  out += card(shown(m.odometry_drift_percent, 2, "%"), "odometry drift",
              verdict(std::isfinite(m.odometry_drift_percent), m.odometry_drift_percent <= 1.0));
  out += card(shown(m.final_error_m, 2, "m"), "true distance to the goal");
  return out + "</section>\n";
}

struct Comparison {
  std::string what;
  std::string here;
  std::string paper;
  std::string best;
};

double max_corrected_error_m(const Metrics& m) {
  double largest = kNaN;
  for (const CorrectionFigure& correction : m.global_corrections)
    if (correction.accepted) largest = std::fmax(largest, correction.after_m);
  return largest;
}

std::string paper_repairs(const Metrics& m) {
  if (m.info.scenario == "seed_traverse_1") return "6 on 86 m";
  if (m.info.scenario == "seed_traverse_2") return "10 on 62.2 m";
  return "6 on 86 m, 10 on 62.2 m";
}

// Metrics beside those of Azkarate et al. 2020 and other sources.
std::string comparison_table(const Metrics& m) {
  std::vector<Comparison> rows = {
      {"Driven / planned path", shown(m.path_ratio, 3), "1.19", ""},
      {"Repairs", fmt::format("{} on {}", m.replans, shown(m.planned_length_m, 1, "m")), paper_repairs(m), ""},
      {"Repairs per metre", shown(m.replans_per_m, 3), "0.11", ""},
      {"Odometry drift", shown(m.odometry_drift_percent, 2, "%"), "1 - 2 %", "1.25 % over 100 m"},
      {"Progress: planned / (0.2 m/s x time)", shown(100.0 * m.progress, 1, "%"), "", ""},
      {"Duty: driven / (0.2 m/s x time)", shown(100.0 * m.duty, 1, "%"), "", "62 %, Perseverance's best sol"},
      {"Cross-track error, rms", shown(m.cross_track_rms_m, 3, "m"), "", ""},
  };
  if (std::isfinite(m.slam_drift_percent))
    rows.push_back({"SLAM drift", shown(m.slam_drift_percent, 2, "%"), "0.8 %", ""});
  const double fixed_m = max_corrected_error_m(m);
  if (std::isfinite(fixed_m))
    rows.push_back({"Maximum error after a global correction", shown(fixed_m, 2, "m"), "below 0.5 m", "0.25 m"});
  std::string out =
      "<h2>Comparison with the paper</h2><table><tr><th></th><th class=\"n\">this run</th><th class=\"n\">paper's "
      "field "
      "test</th><th class=\"n\">best published</th></tr>\n";
  for (const Comparison& row : rows)
    out += fmt::format(
        "<tr><td>{}</td><td class=\"n\"><b>{}</b></td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n", row.what,
        row.here, row.paper, row.best);
  return out +
         "</table><p class=\"meta\">Paper: Azkarate et al., A GNC Architecture for Planetary Rovers with "
         "Autonomous Navigation Capabilities, 2020; both seed traverses, 148.2 m planned.</p>\n";
}

std::string figures_table(const Metrics& m) {
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"Cross-track error, maximum", shown(m.cross_track_max_m, 3, "m")},
      {"True distance from the followed path, maximum", shown(m.truth_deviation_max_m, 3, "m")},
      {"Odometry error, maximum", shown(m.odometry_drift_max_m, 3, "m")},
      {"Final error of the estimate, in map", shown(m.final_estimate_error_m, 3, "m")},
      {"Roll: maximum, rms", shown(m.max_roll_deg, 1) + ", " + shown(m.rms_roll_deg, 1, "deg")},
      {"Pitch: maximum, rms", shown(m.max_pitch_deg, 1) + ", " + shown(m.rms_pitch_deg, 1, "deg")},
      {"Wheel slip, mean", shown(100.0 * m.mean_slip, 1, "%")},
      {"Drive current: mean, maximum", shown(m.mean_abs_current_a, 2) + ", " + shown(m.max_current_a, 2, "A")},
      {"Closest approach of a wheel to a hazard", shown(m.hazard_clearance_m, 2, "m")},
      {"Stereo coverage of the region of interest, mean", shown(100.0 * m.hazard_coverage_mean, 1, "%")},
      {"Hazard maps: total, without coverage",
       fmt::format("{}, {}", m.hazard_frames, m.hazard_frames_without_coverage)},
      {"Odometry frames: total, lost", fmt::format("{}, {}", m.vo_frames, m.vo_lost)},
      {"Hazard rocks: encountered, detected, missed",
       shown(m.rocks_encountered) + ", " + shown(m.rocks_detected) + ", " + shown(m.rocks_missed)},
      {"Bus messages: total, lost", fmt::format("{}, {}", m.bus.messages, m.bus_lost)},
      {"Bus volume", shown(static_cast<double>(m.bus.bytes) / 1e6, 0, "MB")},
      {"Log: damaged records, missing time",
       fmt::format("{}, {}", m.bus.damaged_events, shown(m.bus.missing_s, 1, "s"))},
  };
  std::string left;
  std::string right;
  for (size_t i = 0; i < rows.size(); ++i)
    (2 * i < rows.size() ? left : right) +=
        fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", rows[i].first, rows[i].second);
  return "<h2>More metrics</h2><div class=\"two\"><table>" + left + "</table><table>" + right + "</table></div>\n";
}

std::string corrections_table(const Metrics& m) {
  if (m.global_corrections.empty()) return "";
  std::string out =
      "<table><tr><th class=\"n\">time [s]</th><th>global correction</th><th class=\"n\">error before [m]</th>"
      "<th class=\"n\">after [m]</th><th class=\"n\">of the correction itself [m]</th><th>reason</th></tr>\n";
  for (const CorrectionFigure& c : m.global_corrections)
    out += fmt::format(
        "<tr><td class=\"n\">{:.1f}</td><td class=\"{}\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td>{}</td></tr>\n",
        c.t_s - m.window.begin_s, c.accepted ? "good" : "", c.accepted ? "accepted" : "abstained", shown(c.before_m, 2),
        shown(c.after_m, 2), shown(c.correction_error_m, 2), escaped(c.reason));
  return out + "</table>\n";
}

// Metrics of the Full level, if the run used it.
std::string full_section(const Metrics& m, const Pictures& pictures) {
  if (pictures.elevation.empty() && pictures.levels.empty()) return "";
  std::string out = "<h2>Levels of autonomy</h2>\n<figure>" + pictures.levels + "</figure>\n";
  if (!pictures.elevation.empty())
    out += fmt::format(
        "<h2>Mapped terrain</h2><p class=\"meta\">Elevation map of the NavCam along the track, over the orbital map. "
        "Drift: SLAM {}, odometry {}. Maximum error of the estimate: {}, after the first correction {}.</p>\n"
        "<figure>{}</figure>\n",
        shown(m.slam_drift_percent, 2, "%"), shown(m.odometry_drift_percent, 2, "%"),
        shown(m.estimate_error_max_m, 2, "m"), shown(m.corrected_error_max_m, 2, "m"), pictures.elevation);
  return out + corrections_table(m);
}

std::string events_section(const Scene& scene, const Pictures& pictures) {
  const std::vector<Incident>& incidents = scene.evaluation.incidents;
  std::string out = "<h2>Stops and repairs</h2>\n";
  if (incidents.empty()) return out + "<p>None.</p>\n";
  out +=
      "<p class=\"meta\">Each event from above, on the true terrain: previous path (white), repaired path (violet), "
      "hazard cells that caused it (red), driven track (blue). Below: the LocCam image with the hazard cells of that "
      "exposure.</p>"
      "<div class=\"gallery\">\n";
  for (size_t i = 0; i < pictures.incidents.size(); ++i)
    out +=
        "<figure>" + pictures.incidents[i] + (i < pictures.cameras.size() ? pictures.cameras[i] : "") + "</figure>\n";
  out +=
      "</div>\n<table style=\"margin-top:22px\"><tr><th>#</th><th class=\"n\">time [s]</th><th class=\"n\">driven "
      "[m]</th><th>event</th><th class=\"n\">tallest rock [m]</th><th class=\"n\">hazard "
      "cells</th><th>cause</th></tr>\n";
  const TrueTrack truth(scene.run.truth);
  const double begin_s = scene.evaluation.metrics.window.begin_s;
  for (size_t i = 0; i < incidents.size(); ++i) {
    const Incident& incident = incidents[i];
    const bool evaluated = scene.world.has_value() || incident.unseen;
    const std::string cause = incident.unseen ? "unobserved ground"
                              : !evaluated    ? "not evaluated"
                              : incident.real ? "real"
                                              : "none";
    out += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.1f}</td><td class=\"n\">{:.1f}</td><td>{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"{}\">{}</td></tr>\n",
        i + 1, incident.t_s - begin_s, truth.distance_m(incident.t_s) - truth.distance_m(begin_s),
        escaped(incident_title(scene, i)), incident.tallest_rock_m > 0.0 ? shown(incident.tallest_rock_m, 2) : "",
        incident.cells.size(), verdict(evaluated, !incident.is_false()), cause);
  }
  return out + "</table>\n";
}

std::string faults_section(const Metrics& m) {
  if (m.fdir.empty()) return "";
  std::string out =
      "<h2>Faults</h2><table><tr><th class=\"n\">time [s]</th><th>id</th><th class=\"n\">value</th><th "
      "class=\"n\">limit</th><th>response</th></tr>\n";
  for (const FaultRecord& fault : m.fdir)
    out += fmt::format(
        "<tr><td class=\"n\">{:.2f}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
        fault.t_s - m.window.begin_s, escaped(fault.id), shown(fault.value, 3), shown(fault.limit, 3), fault.response);
  return out + "</table>\n";
}

struct Event {
  double t_s;
  std::string kind;
  std::string text;
};

// State changes, faults and corrections in chronological order.
std::vector<Event> events_of(const RunRecord& run) {
  std::vector<Event> all;
  bool full = false;
  for (const StateChange& change : run.states) {
    std::string text = state_name(change.state) + (change.cause.empty() ? "" : ", cause: " + change.cause);
    if (change.full != full) text += change.full ? "; level FULL" : "; level EFFICIENT";
    full = change.full;
    all.push_back({change.t_s, "state", text});
  }
  for (const FaultRecord& fault : run.faults) {
    const std::string what =
        fault.active ? fmt::format(" raised: {}, limit {}", shown(fault.value, 3), shown(fault.limit, 3)) : " cleared";
    all.push_back({fault.t_s, "fault", fault.id + what});
  }
  for (const CorrectionRecord& correction : run.corrections)
    all.push_back({correction.t_s, "correction", correction.accepted ? "accepted" : "rejected"});
  std::stable_sort(all.begin(), all.end(), [](const Event& a, const Event& b) { return a.t_s < b.t_s; });
  return all;
}

std::string events_section(const Scene& scene) {
  const std::vector<Event> all = events_of(scene.run);
  if (all.empty()) return "";
  const double begin_s = scene.evaluation.metrics.window.begin_s;
  std::string out = fmt::format(
      "<h2>Events</h2><details{}><summary>{} changes of state, faults and corrections</summary><table><tr><th "
      "class=\"n\">time [s]</th><th></th><th>event</th></tr>\n",
      all.size() <= 30 ? " open" : "", all.size());
  for (const Event& event : all)
    out += fmt::format("<tr><td class=\"n\">{:.2f}</td><td class=\"{}\">{}</td><td>{}</td></tr>\n", event.t_s - begin_s,
                       event.kind == "fault" ? "bad" : "", event.kind, escaped(event.text));
  return out + "</table></details>\n";
}

// CPU load as a fraction of one core's simulated time, with a bar.
std::string load_cell(double share, double largest) {
  return fmt::format("<td class=\"n load\" style=\"--load:{:.0f}%\">{}</td>",
                     share > 0.0 && std::isfinite(share) ? 100.0 * share / largest : 0.0, shown(100.0 * share, 1, "%"));
}

std::string services_section(const Metrics& m) {
  double largest = 0.0;
  for (const auto& [name, s] : m.services) largest = std::max(largest, s.cpu_s / m.duration_s);
  std::string out =
      "<h2>Services</h2><table><tr><th>service</th><th class=\"n\">CPU [s]</th><th class=\"n\">of drive "
      "time</th><th class=\"n\">CPU per metre [s/m]</th><th class=\"n\">memory [MB]</th><th class=\"n\">step, "
      "median [ms]</th><th class=\"n\">step, p99 [ms]</th><th class=\"n\">restarts</th></tr>\n";
  for (const auto& [name, s] : m.services)
    out += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.1f}</td>{}<td class=\"n\">{}</td><td class=\"n\">{:.0f}</td><td "
        "class=\"n\">{:.2f}</td><td class=\"n\">{:.2f}</td><td class=\"n{}\">{}</td></tr>\n",
        escaped(name), s.cpu_s, load_cell(s.cpu_s / m.duration_s, largest), shown(s.cpu_s_per_m, 3), s.rss_mb, s.p50_ms,
        s.p99_ms, s.restarts > 0 ? " bad" : "", s.restarts);
  return out + "</table>\n";
}

std::string configuration_section(const std::vector<std::pair<std::string, std::string>>& configuration) {
  if (configuration.empty()) return "";
  std::string out = "<section class=\"configuration\"><h2>Configuration</h2>\n";
  for (size_t i = 0; i < configuration.size(); ++i)
    out += fmt::format("<details{}><summary>{}</summary><pre>{}</pre></details>\n", i == 0 ? " open" : "",
                       escaped(configuration[i].first), escaped(configuration[i].second));
  return out + "</section>\n";
}

}  // namespace

std::string report_html(const Scene& scene, const Pictures& pictures,
                        const std::vector<std::pair<std::string, std::string>>& configuration) {
  const Metrics& m = scene.evaluation.metrics;
  std::string body = header(m) + remarks(m) + cards(m) + layered_maps(pictures.map);
  body += time_section(m) + full_section(m, pictures) + trajectory_section(m) + comparison_table(m) +
          events_section(scene, pictures);
  body += "<h2>Over driven distance [m]</h2><section class=\"plots\">\n";
  for (const std::string& plot : pictures.plots) body += plot;
  body += pictures.states + "</section>\n";
  body += fidelity_section(m) + figures_table(m) + events_section(scene) + faults_section(m) + services_section(m) +
          configuration_section(configuration);
  return document("Traverse: " + m.info.scenario, body);
}

}  // namespace rover::report
