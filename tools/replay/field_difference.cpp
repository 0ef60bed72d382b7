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
  const Leaves recorded = leaves_of(difference.name.channel, difference.recorded);
  const Leaves live = leaves_of(difference.name.channel, difference.live);
  for (size_t i = 0; i < recorded.size() && i < live.size(); ++i)
    if (recorded[i] != live[i])
      return recorded[i].first + " is " + recorded[i].second + " in the log, " + live[i].second + " now";
  return {};
}

}  // namespace rover::replay
