#include "tools/report/time_section.hpp"

#include <fmt/format.h>

#include "tools/report/html_parts.hpp"

namespace rover::report {
namespace {

// Progress in blues and greens, what delays it in warm colours.
constexpr const char* kColours[kTimeCauses] = {"#1458b8", "#5b9bd5", "#2a9d8f", "#9bd1c6", "#8e2fb5", "#f08a24",
                                               "#e02020", "#f4c95d", "#5d4037", "#8b0000", "#b0b7bf"};

std::string time_bar(const Metrics& m) {
  std::string out = "<div class=\"timebar\" role=\"img\" aria-label=\"Seconds by cause\">";
  for (int i = 0; i < kTimeCauses; ++i) {
    const auto cause = static_cast<TimeCause>(i);
    const double seconds = m.time.of(cause);
    if (seconds > 0.0)
      out += fmt::format("<i style=\"flex-grow:{:.3f};background:{}\" title=\"{}: {:.1f} s\"></i>", seconds,
                         kColours[i], title_of(cause), seconds);
  }
  return out + "</div>\n";
}

std::string time_key(const Metrics& m) {
  std::string out = "<div class=\"timekey\">";
  for (int i = 0; i < kTimeCauses; ++i) {
    const auto cause = static_cast<TimeCause>(i);
    const double seconds = m.time.of(cause);
    out += fmt::format("<div{}><i style=\"background:{}\"></i><span>{}</span><b>{:.1f} s</b><em>{:.1f} %</em></div>\n",
                       seconds >= 0.05 ? "" : " class=\"none\"", kColours[i], title_of(cause), seconds,
                       100.0 * seconds / m.duration_s);
  }
  return out + "</div>\n";
}

}  // namespace

std::string time_section(const Metrics& m) {
  if (!(m.duration_s > 0.0)) return "";
  return "<h2>Where the time went</h2>\n" + time_bar(m) + time_key(m) +
         fmt::format(
             "<p class=\"meta\">{} in all. Progress (planned length at top speed, over this time): {}. Duty (driven "
             "length at top speed): {}. In reverse: {}.</p>\n",
             shown(m.duration_s, 1, "s"), shown(100.0 * m.progress, 1, "%"), shown(100.0 * m.duty, 1, "%"),
             shown(m.reverse_m, 1, "m"));
}

}  // namespace rover::report
