#include "tools/replay/verdict_text.hpp"

#include <algorithm>
#include <cstdio>

namespace rover::replay {
namespace {

std::string byte_text(const Bytes& then, const Bytes& now) {
  char text[128];
  if (then.size() != now.size()) {
    std::snprintf(text, sizeof text, "%zu bytes in the log, %zu now", then.size(), now.size());
    return text;
  }
  const auto at = std::mismatch(then.begin(), then.end(), now.begin());
  std::snprintf(text, sizeof text, "byte %zu of %zu is %02x in the log, %02x now",
                static_cast<size_t>(at.first - then.begin()), then.size(), *at.first, *at.second);
  return text;
}

std::string what_differs(const Difference& difference, NameField name_field) {
  switch (difference.kind) {
    case Difference::Kind::kMissingNow:
      return "in the log, not said now";
    case Difference::Kind::kNotInLog:
      return "said now, not in the log";
    case Difference::Kind::kContent:
      break;
  }
  const std::string field = name_field(difference);
  return field.empty() ? byte_text(difference.then, difference.now) : field;
}

}  // namespace

std::string difference_text(const Difference& difference, NameField name_field) {
  const MessageName& name = difference.name;
  char text[256];
  std::snprintf(text, sizeof text, "%s of %s, seq %lld, released at %.6f s: ", name.channel.c_str(),
                name.publisher.c_str(), static_cast<long long>(name.seq), to_seconds(name.release));
  return text + what_differs(difference, name_field);
}

std::string verdict_table(const std::vector<StreamVerdict>& verdicts, NameField name_field) {
  std::string table;
  for (const StreamVerdict& verdict : verdicts) {
    char line[128];
    std::snprintf(line, sizeof line, "%-18s %-20s %7lld identical", verdict.channel.c_str(), verdict.publisher.c_str(),
                  static_cast<long long>(verdict.identical));
    table += line;
    if (verdict.first) table += ", then " + difference_text(*verdict.first, name_field);
    table += "\n";
  }
  return table;
}

}  // namespace rover::replay
