#include "tools/replay/field_difference.hpp"

#include <utility>
#include <vector>

#include "common/bus/message_fields.hpp"

namespace rover::replay {
namespace {

using Leaves = std::vector<std::pair<std::string, std::string>>;  // path, text

Leaves leaves_of(const std::string& channel, const Bytes& bytes) {
  Leaves leaves;
  const auto fields = decode_fields(channel, bytes.data(), static_cast<int>(bytes.size()));
  if (fields)
    visit_leaves(*fields, [&](const Leaf& leaf) { leaves.emplace_back(leaf.path, text_of(leaf.field, leaf.index)); });
  return leaves;
}

}  // namespace

std::string field_difference(const Difference& difference) {
  const Leaves then = leaves_of(difference.name.channel, difference.then);
  const Leaves now = leaves_of(difference.name.channel, difference.now);
  for (size_t i = 0; i < then.size() && i < now.size(); ++i)
    if (then[i] != now[i]) return then[i].first + " is " + then[i].second + " in the log, " + now[i].second + " now";
  return {};
}

}  // namespace rover::replay
