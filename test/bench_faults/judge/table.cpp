#include "test/bench_faults/judge/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>

#include "test/bench_faults/phase.hpp"

namespace rover::bench_faults {
namespace {

constexpr int kLeastOfRow = 20;
constexpr size_t kLeastInAll = 1000;
constexpr double kLeastNamed = 0.99;
constexpr double kMostWithdrawnS = 0.050;
constexpr double kMostStillS = 1.0;

using Verdicts = std::vector<const Verdict*>;

std::string text(const char* format, double value) {
  char out[64];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

// Sorted; only of verdicts with a value.
std::vector<double> values(const Verdicts& of, const std::function<std::optional<double>(const Verdict&)>& read) {
  std::vector<double> out;
  for (const Verdict* verdict : of)
    if (const auto value = read(*verdict)) out.push_back(*value);
  std::sort(out.begin(), out.end());
  return out;
}

double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::max<size_t>(rank, 1) - 1];
}

size_t count(const Verdicts& of, const std::function<bool(const Verdict&)>& is) {
  return static_cast<size_t>(std::count_if(of.begin(), of.end(), [&](const Verdict* v) { return is(*v); }));
}

std::optional<double> withdrawn_ms(const Verdict& v) {
  return v.withdrawn_s ? std::optional(1e3 * *v.withdrawn_s) : std::nullopt;
}
std::optional<double> since_known_ms(const Verdict& v) {
  return v.withdrawn_since_known_s ? std::optional(1e3 * *v.withdrawn_since_known_s) : std::nullopt;
}

std::string quantiles(const std::vector<double>& sorted, const char* format, bool with_median) {
  if (sorted.empty()) return with_median ? "- | - | -" : "- | -";
  const std::string median = with_median ? text(format, quantile(sorted, 0.5)) + " | " : "";
  return median + text(format, quantile(sorted, 0.99)) + " | " + text(format, sorted.back());
}

struct Requirements {
  std::ostream& out;
  bool all_met = true;

  void line(const std::string& requirement, const std::string& measured, bool met) {
    out << "| " << requirement << " | " << measured << " | " << (met ? "yes" : "**no**") << " |\n";
    all_met = all_met && met;
  }
};

std::string of(const Verdicts& all) {
  return " of " + std::to_string(all.size());
}

// An injection may not hold its row's quantity beyond the limit for long enough; then there is no fault to detect,
// which the judge determines from the messages.
bool takes(const Verdict& v) {
  return v.visible != kNever || v.raised != kNever;
}

bool write_requirements(const Settings& settings, const Judge& judge, const Verdicts& all, std::ostream& out) {
  out << "| requirement | measured | met |\n|---|---|---|\n";
  Requirements requirements{out};
  size_t least = all.size();
  for (const Row& row : settings.rows)
    least = std::min(least, count(all, [&](const Verdict& v) { return v.line == row.line && takes(v); }));
  const size_t took = count(all, takes);
  const size_t detected = count(all, [](const Verdict& v) { return takes(v) && v.detected; });
  const size_t named = count(all, [](const Verdict& v) { return takes(v) && v.named; });
  const std::string of_all = " of " + std::to_string(took);
  requirements.line("at least 1000 injections that cause a fault", std::to_string(took) + of(all), took >= kLeastInAll);
  requirements.line("every row at least 20 times", "minimum " + std::to_string(least), least >= kLeastOfRow);
  requirements.line("detected 100 %", std::to_string(detected) + of_all, detected == took);
  requirements.line("right row named at least 99 %", std::to_string(named) + of_all,
                    static_cast<double>(named) >= kLeastNamed * static_cast<double>(took));
  const double since_visible = quantile(values(all, withdrawn_ms), 0.99);
  const double since_known = quantile(values(all, since_known_ms), 0.99);
  requirements.line("from visible to permit withdrawn, p99 at most 50 ms",
                    text("%.0f ms", since_visible) + "; from the release of the message that shows it " +
                        text("%.0f ms", since_known),
                    since_visible <= 1e3 * kMostWithdrawnS);
  const std::vector<double> still = values(all, [](const Verdict& v) { return v.still_s; });
  const double longest = still.empty() ? 0.0 : still.back();
  requirements.line("wheels stationary at most 1.0 s later (from 0.1 m/s; here from up to 0.2 m/s)",
                    text("at most %.2f s", longest), longest <= kMostStillS);
  requirements.line("no row raised without a fault in the messages", std::to_string(judge.false_alarms().size()),
                    judge.false_alarms().empty());
  return requirements.all_met;
}

void write_row(const std::string& line, const Verdicts& of, std::ostream& out) {
  out << "| " << line << " |";
  for (const char* phase : kPhaseNames) {
    const size_t in_phase = count(of, [&](const Verdict& v) { return v.phase == phase; });
    out << ' ' << (in_phase == 0 ? "-" : std::to_string(in_phase)) << " |";
  }
  const size_t took = count(of, takes);
  out << ' ' << count(of, [](const Verdict& v) { return takes(v) && v.detected; }) << " of " << took << " | "
      << count(of, [](const Verdict& v) { return takes(v) && v.named; }) << " of " << took << " | "
      << values(of, withdrawn_ms).size() << " | " << quantiles(values(of, withdrawn_ms), "%.0f", true) << " | "
      << quantiles(values(of, [](const Verdict& v) { return v.still_s; }), "%.2f", false) << " |\n";
}

void write_failures(const Judge& judge, const Verdicts& all, std::ostream& out) {
  if (count(all, [](const Verdict& v) { return !v.detected || !v.named; }) > 0) {
    out << "\n## Not detected or not named\n\n"
        << "Without times in \"visible\" and \"raised\" the injection caused no fault in the messages and does not "
           "count.\n\n"
        << "| injection | at [s] | row | phase | cause | visible at [s] | raised at [s] | first row raised |\n"
        << "|---|---|---|---|---|---|---|---|\n";
    const auto at = [](Utime utime) { return utime == kNever ? std::string("-") : text("%.2f", to_seconds(utime)); };
    for (const Verdict* v : all)
      if (!v->detected || !v->named)
        out << "| " << v->injection_id << " | " << at(v->begun) << " | " << v->row << " | " << v->phase << " | "
            << v->cause << " | " << at(v->visible) << " | " << at(v->raised) << " | " << v->first_raised << " |\n";
  }
  if (judge.false_alarms().empty()) return;
  out << "\n## Raised without a fault in the messages\n\n| at [s] | row |\n|---|---|\n";
  for (const FalseAlarm& alarm : judge.false_alarms())
    out << "| " << text("%.2f", to_seconds(alarm.utime)) << " | " << alarm.row << " |\n";
}

}  // namespace

bool write_table(const Heading& heading, const Settings& settings, const Judge& judge, std::ostream& out) {
  Verdicts all;
  for (const Verdict& verdict : judge.verdicts()) all.push_back(&verdict);
  out << "# Faults on the stack in one process\n\nCommand: `" << heading.command << "`; commit " << heading.commit
      << "; " << heading.machine << ".\n\n"
      << "Every row of `config/fdir.yaml` on one long-lived stack (" << text("%.0f s", judge.duration_s())
      << " of message time), with a geometric DISPARITY and VO in place of rendering. An independent judge "
         "(`test/bench_faults/judge`)\nfinds from the recorded messages when each fault was visible, and from the "
         "truth "
         "when the rover was stationary.\n\n";
  const bool met = write_requirements(settings, judge, all, out);
  out << "\nA row that stops the rover has its times where a permit was granted when the fault became visible; `log` "
         "and "
         "`slow` have none.\n\"-\" in a phase: the row is not armed in it, or its quantity cannot go bad there.\n\n"
      << "| row | straight | point turn | hazard stop | repair | stationary | detected | named | with a permit | "
         "withdrawn p50 [ms] | p99 | max | stop p99 [s] | max "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::set<std::string> written;
  for (const Row& row : settings.rows) {
    if (!written.insert(row.line).second) continue;
    Verdicts of;
    std::copy_if(all.begin(), all.end(), std::back_inserter(of), [&](const Verdict* v) { return v->line == row.line; });
    write_row(row.line, of, out);
  }
  write_row("**all**", all, out);
  write_failures(judge, all, out);
  return met;
}

}  // namespace rover::bench_faults
