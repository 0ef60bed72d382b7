#include "tools/replay/comparison.hpp"

#include <algorithm>

namespace rover::replay {
namespace {

// one side may lead by its latency; older unmatched messages are lost and only cost memory
constexpr size_t kMaxUnmatched = 2000;

auto order(const Difference& d) {
  return std::tie(d.name.release, d.name.channel, d.name.publisher, d.name.boot_id, d.name.seq);
}

void keep_earliest(std::optional<Difference>& earliest, Difference found) {
  if (!earliest || order(found) < order(*earliest)) earliest = std::move(found);
}

}  // namespace

void Comparison::add(const MessageName& name, const Bytes& bytes, bool recorded) {
  Stream& stream = streams_[{name.channel, name.publisher}];
  const Id id{name.boot_id, name.seq};
  Unmatched mine{name, bytes, recorded};
  const auto it = stream.unmatched.find(id);
  if (it == stream.unmatched.end()) {
    if (stream.unmatched.size() < kMaxUnmatched) stream.unmatched.emplace(id, std::move(mine));
    return;
  }
  if (it->second.recorded == recorded) return;  // duplicate
  compare(stream, recorded ? mine : it->second, recorded ? it->second : mine);
  stream.unmatched.erase(it);
}

void Comparison::compare(Stream& stream, const Unmatched& recorded, const Unmatched& live) {
  if (recorded.bytes == live.bytes) {
    if (!stream.first) ++stream.identical;
    return;
  }
  keep_earliest(stream.first, {Difference::Kind::kContent, recorded.name, recorded.bytes, live.bytes});
}

std::vector<StreamComparison> Comparison::finish(Utime end) {
  std::vector<StreamComparison> results;
  for (auto& [key, stream] : streams_) {
    for (auto& [id, alone] : stream.unmatched) {
      if (alone.name.release > end) continue;
      if (alone.recorded)
        keep_earliest(stream.first, {Difference::Kind::kMissingLive, alone.name, std::move(alone.bytes), {}});
      else
        keep_earliest(stream.first, {Difference::Kind::kNotInLog, alone.name, {}, std::move(alone.bytes)});
    }
    stream.unmatched.clear();
    if (stream.identical == 0 && !stream.first) continue;
    results.push_back({key.first, key.second, stream.identical, std::move(stream.first)});
  }
  return results;
}

std::optional<Difference> first_of(const std::vector<StreamComparison>& results) {
  std::optional<Difference> first;
  for (const StreamComparison& result : results)
    if (result.first) keep_earliest(first, *result.first);
  return first;
}

}  // namespace rover::replay
