#include "tools/spy/table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/spy/field_lines.hpp"
#include "tools/status/text_line.hpp"

namespace rover::spy {
namespace {

using status::Colour;
using status::fixed;
using status::left;
using status::Line;
using status::right;
using Lines = std::vector<Line>;

std::optional<Fields> fields_of(const std::string& name, const ChannelStatistics& channel) {
  return decode_fields(name, channel.newest.data(), static_cast<int>(channel.newest.size()));
}

Line title(const TrafficStatistics& statistics, const std::string& source) {
  std::string text = status::printable(source);
  double bytes_per_s = 0.0;
  for (const auto& [name, channel] : statistics.channels)
    bytes_per_s += std::isfinite(channel.bytes_per_s) ? channel.bytes_per_s : 0.0;
  if (statistics.now != kNever) text += "   message time " + fixed(to_seconds(statistics.now), 2) + " s";
  if (std::isfinite(statistics.realtime_factor))
    text += "   " + fixed(statistics.realtime_factor, 2) + " times real time";
  return {{text + "   " + fixed(bytes_per_s * 1e-6, 2) + " MB/s"}};
}

Line head() {
  return {{left("CHANNEL", 18) + right("Hz", 8) + right("AGE s", 9) + right("GAPS", 7) + right("BAD", 6) +
               right("kB/s", 9) + right("MESSAGES", 10) + "  FIELDS",
           Colour::kBold}};
}

Line figures_line(const std::string& name, const ChannelStatistics& c) {
  return {{left(status::printable(name), 18)},
          {right(fixed(c.hz, 2), 8) + right(fixed(c.age_s, 2), 9)},
          {right(std::to_string(c.gaps), 7), c.gaps > 0 ? Colour::kYellow : Colour::kPlain},
          {right(std::to_string(c.malformed), 6), c.malformed > 0 ? Colour::kRed : Colour::kPlain},
          {right(fixed(c.bytes_per_s * 1e-3, 1), 9) + right(std::to_string(c.messages), 10)}};
}

Line row(const std::string& name, const ChannelStatistics& channel) {
  Line line = figures_line(name, channel);
  const auto fields = fields_of(name, channel);
  line.push_back({"  " + (fields ? digest(*fields) : fmt::format("? {} B", channel.newest.size()))});
  return line;
}

void add_fields(const std::string& name, const ChannelStatistics& channel, Lines& lines) {
  lines.push_back(figures_line(name, channel));
  std::string from;
  for (const std::string& publisher : channel.publishers) from += " " + publisher;
  lines.push_back({{"  " + (channel.type.empty() ? "unknown type" : channel.type) +
                        (from.empty() ? "" : " from" + status::printable(from)),
                    Colour::kBold}});
  if (const auto fields = fields_of(name, channel))
    for (const std::string& line : field_lines(*fields)) lines.push_back({{line}});
  lines.emplace_back();
}

}  // namespace

std::string table(const TrafficStatistics& statistics, const std::string& source, const std::set<std::string>& chosen,
                  const status::ScreenOptions& options) {
  Lines lines = {title(statistics, source), head()};
  for (const auto& [name, channel] : statistics.channels) {
    if (chosen.contains(name)) add_fields(name, channel, lines);
    if (chosen.empty()) lines.push_back(row(name, channel));
  }
  if (lines.size() > options.rows) {
    const size_t more = lines.size() - options.rows + 1;
    lines.resize(options.rows - 1);
    lines.push_back({{fmt::format("and {} more lines; enlarge the terminal or use --once", more)}});
  }
  std::string out;
  for (const Line& line : lines) out += rendered(line, options.columns, options.colours) + "\n";
  return out;
}

}  // namespace rover::spy
