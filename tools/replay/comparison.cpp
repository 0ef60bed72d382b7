#include "tools/replay/comparison.hpp"

#include <algorithm>

namespace rover::replay {
namespace {

// A stream may lead the other side by its latency; beyond this the rest is lost anyhow and only costs memory.
constexpr size_t kMostWaiting = 2000;

auto order(const Difference& d) {
  return std::tie(d.name.release, d.name.channel, d.name.publisher, d.name.boot_id, d.name.seq);
}

void keep_earlier(std::optional<Difference>& kept, Difference found) {
  if (!kept || order(found) < order(*kept)) kept = std::move(found);
}

}  // namespace

void Comparison::take(const MessageName& name, const Bytes& bytes, bool recorded) {
  Stream& stream = streams_[{name.channel, name.publisher}];
  const Id id{name.boot_id, name.seq};
  Waiting mine{name, bytes, recorded};
  const auto it = stream.waiting.find(id);
  if (it == stream.waiting.end()) {
    if (stream.waiting.size() < kMostWaiting) stream.waiting.emplace(id, std::move(mine));
    return;
  }
  if (it->second.recorded == recorded) return;  // said twice
  settle(stream, recorded ? mine : it->second, recorded ? it->second : mine);
  stream.waiting.erase(it);
}

void Comparison::settle(Stream& stream, const Waiting& then, const Waiting& now) {
  if (then.bytes == now.bytes) {
    if (!stream.first) ++stream.identical;
    return;
  }
  keep_earlier(stream.first, {Difference::Kind::kContent, then.name, then.bytes, now.bytes});
}

std::vector<StreamVerdict> Comparison::finish(Utime end) {
  std::vector<StreamVerdict> verdicts;
  for (auto& [key, stream] : streams_) {
    for (auto& [id, alone] : stream.waiting) {
      if (alone.name.release > end) continue;
      if (alone.recorded)
        keep_earlier(stream.first, {Difference::Kind::kMissingNow, alone.name, std::move(alone.bytes), {}});
      else
        keep_earlier(stream.first, {Difference::Kind::kNotInLog, alone.name, {}, std::move(alone.bytes)});
    }
    stream.waiting.clear();
    if (stream.identical == 0 && !stream.first) continue;
    verdicts.push_back({key.first, key.second, stream.identical, std::move(stream.first)});
  }
  return verdicts;
}

std::optional<Difference> first_of(const std::vector<StreamVerdict>& verdicts) {
  std::optional<Difference> first;
  for (const StreamVerdict& verdict : verdicts)
    if (verdict.first) keep_earlier(first, *verdict.first);
  return first;
}

}  // namespace rover::replay
