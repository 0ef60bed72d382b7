#include "common/bus/log_runs.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <rover/tick_t.hpp>
#include <utility>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

class RunFinder {
 public:
  // `skipped_bytes`: of the log before this record.
  void add(const LogPlace& place, const LogEvent& event, std::int64_t skipped_bytes) {
    const Mark here{place, records_++, skipped_bytes};
    header_t header{};
    if (!peek_header(event.data, event.size, header)) header.release_utime = std::numeric_limits<Utime>::max();
    // Only records with a new minimum of the release can be the first one released before a tick.
    if (since_tick_.empty() || header.release_utime < since_tick_.back().release)
      since_tick_.push_back({here, header.release_utime});
    if (event.channel != channel::kTick) return;
    tick_t tick{};
    if (find_channel_type(channel::kTick)->decodes(event.data, event.size) &&
        decode_message(event.data, event.size, tick) && peek_header(event.data, event.size, header))
      add_tick(here, header);
    else
      ++run_.bad_ticks;
  }

  std::vector<LogRun> finish(const LogPlace& end, std::int64_t skipped_bytes) {
    end_run({end, records_, skipped_bytes});
    return std::move(runs_);
  }

 private:
  struct Mark {
    LogPlace place;
    std::int64_t records = 0;  // before this place
    std::int64_t skipped_bytes = 0;
  };
  struct Candidate {
    Mark mark;
    Utime release;
  };

  void add_tick(const Mark& here, const header_t& tick) {
    const bool first = run_.last_tick == kNever;
    const bool gap = !first && tick.utime - run_.last_tick > kLongestPause;
    if (!first && (tick.utime < run_.last_tick || (gap && tick.seq <= last_seq_))) {
      end_run(beginning_of(tick.utime, here));
    } else if (gap && tick.utime - run_.last_tick > run_.gap_to - run_.gap_from) {
      run_.gap_from = run_.last_tick;
      run_.gap_to = tick.utime;
    }
    if (run_.last_tick == kNever) run_.first_tick = tick.utime;
    run_.last_tick = tick.utime;
    last_seq_ = tick.seq;
    since_tick_.clear();
  }
  Mark beginning_of(Utime first_tick, const Mark& tick) const {
    const auto it = std::find_if(since_tick_.begin(), since_tick_.end(),
                                 [&](const Candidate& candidate) { return candidate.release <= first_tick; });
    return it == since_tick_.end() ? tick : it->mark;
  }
  void end_run(const Mark& end) {
    run_.begin = begin_.place;
    run_.end = end.place;
    run_.records = end.records - begin_.records;
    run_.skipped_bytes = end.skipped_bytes - begin_.skipped_bytes;
    runs_.push_back(std::exchange(run_, {}));
    begin_ = end;
  }

  std::vector<LogRun> runs_;
  LogRun run_;
  Mark begin_;
  std::int64_t last_seq_ = 0;
  std::int64_t records_ = 0;
  std::vector<Candidate> since_tick_;  // with decreasing releases
};

std::string seconds(Utime t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", to_seconds(t));
  return text;
}

std::string list_of(const std::vector<LogRun>& runs) {
  constexpr size_t kMax = 5;
  std::string text;
  for (size_t i = 0; i < std::min(runs.size(), kMax); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(i + 1) + ": " + seconds(runs[i].first_tick) + " - " +
            seconds(runs[i].last_tick) + " s";
  return text + (runs.size() > kMax ? " ..." : "");
}

std::vector<std::string> remarks_on_parts(const std::string& log) {
  std::vector<std::string> lines;
  const std::vector<std::string> parts = log_parts(log);
  for (const std::string& part : parts)
    if (fs::is_empty(part)) lines.push_back(part + ": this part of the log is empty");
  const int count = static_cast<int>(parts.size());
  if (fs::exists(log_part(log, count + 2)))
    lines.push_back(log_part(log, count + 1) + ": this part of the log is missing; the following parts are not read");
  return lines;
}

}  // namespace

std::vector<LogRun> log_runs(const std::string& log_or_run) {
  const std::string log = log_file(log_or_run);
  const std::vector<std::string> parts = log_parts(log);
  RunFinder finder;
  std::int64_t skipped_bytes = 0;
  std::int64_t bytes = 0;
  std::int64_t records = 0;
  LogPlace end;
  for (size_t part = 0; part < parts.size(); ++part) {
    EventLogReader reader(parts[part]);
    for (LogEvent event; reader.next(event);)
      finder.add({part, event.begin}, event, skipped_bytes + reader.length().skipped_bytes);
    skipped_bytes += reader.length().skipped_bytes;
    records += reader.length().records;
    bytes += reader.size();
    end = {part, reader.size()};
  }
  if (bytes == 0) throw ConfigError(log + ": is empty");
  if (records == 0) throw ConfigError(log + ": contains no messages; is it an LCM log?");
  std::vector<LogRun> runs = finder.finish(end, skipped_bytes);
  for (size_t i = 0; i < runs.size(); ++i) {
    runs[i].log = log;
    runs[i].number = i + 1;
    runs[i].of = runs.size();
  }
  return runs;
}

LogRun choose_run(const std::string& log_or_run, int number) {
  const std::vector<LogRun> runs = log_runs(log_or_run);
  const bool named = number != 0;
  if (!named && runs.size() == 1) return runs.front();
  if (number >= 1 && static_cast<size_t>(number) <= runs.size()) return runs[static_cast<size_t>(number) - 1];
  const std::string held = runs.front().log + ": contains " + std::to_string(runs.size()) +
                           (runs.size() == 1 ? " run" : " runs") + ", message time " + list_of(runs);
  throw ConfigError(held +
                    (named ? "; there is no --log-run " + std::to_string(number) : "; choose one with --log-run N"));
}

std::vector<std::string> remarks(const LogRun& run) {
  std::vector<std::string> lines = remarks_on_parts(run.log);
  if (run.of > 1)
    lines.push_back(run.log + ": run " + std::to_string(run.number) + " of " + std::to_string(run.of) +
                    ", message time " + seconds(run.first_tick) + " - " + seconds(run.last_tick) + " s");
  if (run.gap_to != kNever)
    lines.push_back(run.log + ": message time jumps from " + seconds(run.gap_from) + " to " + seconds(run.gap_to) +
                    " s: a clock that was set, or a pause of the recorder");
  if (run.bad_ticks > 0)
    lines.push_back(run.log + ": " + std::to_string(run.bad_ticks) +
                    " TICK messages are damaged or of another version");
  if (run.skipped_bytes > 0)
    lines.push_back(run.log + ": truncated or damaged: " + std::to_string(run.records) + " messages are intact, " +
                    std::to_string(run.skipped_bytes) + " bytes are skipped; ./rover repair writes a log without them");
  return lines;
}

void print_remarks(const LogRun& run) {
  for (const std::string& line : remarks(run)) std::fprintf(stderr, "%s\n", line.c_str());
}

void for_each_event(const LogRun& run, const std::function<void(const LogEvent&)>& take) {
  const std::vector<std::string> parts = log_parts(run.log);
  for (size_t part = run.begin.part; part <= run.end.part && part < parts.size(); ++part) {
    EventLogReader reader(parts[part]);
    if (part == run.begin.part) reader.seek(run.begin.offset);
    for (LogEvent event; reader.next(event) && LogPlace{part, event.begin} < run.end;) take(event);
  }
}

}  // namespace rover
