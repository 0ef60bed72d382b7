#include "tools/report/html_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/report/html_style.hpp"
#include "tools/report/map_picture.hpp"
#include "tools/report/metrics.hpp"
#include "tools/report/slope_map.hpp"
#include "tools/report/svg.hpp"

namespace rover::report {
namespace {

std::string slope_key() {
  std::string out;
  double from = 0.0;
  for (const SlopeClass& slope : kSlopeClasses) {
    const bool last = &slope == &kSlopeClasses.back();
    out += fmt::format("<i style=\"background:{}\"></i>{}", slope.colour,
                       last ? fmt::format("over {:.0f} deg", from) : fmt::format("to {:.0f}", slope.to_deg));
    from = slope.to_deg;
  }
  return "<span class=\"slope-key\">" + out + "</span>";
}

}  // namespace

std::string shown(double value, int decimals, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.{}f}{}{}", value, decimals, *unit != '\0' ? " " : "", unit) : "n/a";
}
std::string shown(const std::optional<int>& value) {
  return value ? std::to_string(*value) : "n/a";
}

std::string verdict(bool known, bool good) {
  return !known ? "" : good ? "good" : "bad";
}

std::string outcome_text(const std::string& outcome) {
  if (outcome == "goal_reached") return "Goal reached";
  if (outcome == "fault_stop") return "Fault stop";
  if (outcome == "no_path") return "No path";
  if (outcome == "collision") return "Collision";
  return outcome == "timeout" ? "Timeout" : outcome;
}

std::string run_facts(const RunInfo& info) {
  std::string facts;
  const auto add = [&facts](const std::string& text) { facts += (facts.empty() ? "" : " &middot; ") + escaped(text); };
  if (info.seed) add("seed " + std::to_string(*info.seed));
  if (!info.level.empty()) add("level " + info.level);
  if (!info.perception.empty() && info.perception != "rendered") add("perception " + info.perception + ", no images");
  if (!info.commit.empty()) add("commit " + info.commit);
  if (info.deterministic) add(*info.deterministic ? "deterministic" : "not deterministic");
  if (info.realtime && *info.realtime) add("real time");
  return facts;
}

std::string remarks(const Metrics& m) {
  std::string out;
  if (m.paths.size() > 1)
    out += fmt::format(
        "<p class=\"meta\">The rover followed {} paths: there is no planned length, thus no ratio, progress and "
        "regret.</p>\n",
        m.paths.size());
  if (m.bus.missing_end_s > 0.0)
    out += fmt::format(
        "<p class=\"meta\">The log ends {:.1f} s before the run: the metrics are of the drive until then.</p>\n",
        m.bus.missing_end_s);
  return out;
}

// The switches precede the layers: the CSS sibling selector requires it.
std::string layered_maps(const std::string& maps) {
  std::string rules;
  std::string switches;
  for (const MapLayerInfo& layer : kMapLayers) {
    rules += fmt::format(
        "#show-{0}:not(:checked)~.maps .layer-{0}{{display:none}}#show-{0}:checked~.maps "
        ".layer-{0}{{display:inline}}\n",
        layer.id);
    switches += fmt::format("<input type=\"checkbox\" id=\"show-{0}\"{1}><label for=\"show-{0}\">{2}</label>\n",
                            layer.id, layer.on ? " checked" : "", layer.title);
  }
  return "<style>" + rules + "</style><section class=\"map\">" + switches + slope_key() + "<div class=\"maps\">" +
         maps + "</div></section>\n";
}

std::string document(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\"><title>{}</title><style>{}</style></head>\n"
      "<body><main>\n{}</main></body></html>\n",
      escaped(title), kStyleSheet, body);
}

}  // namespace rover::report
