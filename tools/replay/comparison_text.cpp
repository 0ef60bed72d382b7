#include "tools/replay/comparison_text.hpp"

#include <algorithm>
#include <cstdio>

namespace rover::replay {
namespace {

std::string byte_text(const Bytes& recorded, const Bytes& live) {
  char text[128];
  if (recorded.size() != live.size()) {
    std::snprintf(text, sizeof text, "%zu bytes in the log, %zu now", recorded.size(), live.size());
    return text;
  }
  const auto at = std::mismatch(recorded.begin(), recorded.end(), live.begin());
  std::snprintf(text, sizeof text, "byte %zu of %zu is %02x in the log, %02x now",
                static_cast<size_t>(at.first - recorded.begin()), recorded.size(), *at.first, *at.second);
  return text;
}

std::string what_differs(const Difference& difference, NameField name_field) {
  switch (difference.kind) {
    case Difference::Kind::kMissingLive:
      return "in the log, not published now";
    case Difference::Kind::kNotInLog:
      return "published now, not in the log";
    case Difference::Kind::kContent:
      break;
  }
  const std::string field = name_field(difference);
  return field.empty() ? byte_text(difference.recorded, difference.live) : field;
}

}  // namespace

std::string difference_text(const Difference& difference, NameField name_field) {
  const MessageName& name = difference.name;
  char text[256];
  std::snprintf(text, sizeof text, "%s of %s, seq %lld, released at %.6f s: ", name.channel.c_str(),
                name.publisher.c_str(), static_cast<long long>(name.seq), to_seconds(name.release));
  return text + what_differs(difference, name_field);
}

std::string comparison_table(const std::vector<StreamComparison>& results, NameField name_field) {
  std::string table;
  for (const StreamComparison& result : results) {
    char line[128];
    std::snprintf(line, sizeof line, "%-18s %-20s %7lld identical", result.channel.c_str(), result.publisher.c_str(),
                  static_cast<long long>(result.identical));
    table += line;
    if (result.first) table += ", then " + difference_text(*result.first, name_field);
    table += "\n";
  }
  return table;
}

}  // namespace rover::replay
