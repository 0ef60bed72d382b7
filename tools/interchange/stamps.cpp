#include "tools/interchange/stamps.hpp"

#include <algorithm>

#include "common/bus/config.hpp"

namespace rover::interchange {
namespace {

constexpr std::int64_t kMaxStampGapNs = 60'000'000'000;
constexpr std::int64_t kMinIntervalNs = 1'000'000;
constexpr std::int64_t kMaxIntervalNs = 10'000'000'000;

std::string seconds(std::int64_t ns) {
  return std::to_string(static_cast<double>(ns) * 1e-9) + " s";
}

}  // namespace

void Stamps::add(std::int64_t time_ns, const std::function<void(const std::string&)>& fail) {
  if (!times_ns_.empty()) {
    const std::int64_t before_ns = times_ns_.back();
    if (time_ns <= before_ns) fail("times do not increase");
    if (time_ns - before_ns > kMaxStampGapNs)
      fail(seconds(time_ns - before_ns) + " after the picture before; at most 60 s are expected");
  }
  times_ns_.push_back(time_ns);
}

std::int64_t Stamps::interval_ns(const std::string& file) const {
  if (times_ns_.size() < 2) return kMaxIntervalNs;
  std::vector<std::int64_t> steps;
  for (size_t i = 1; i < times_ns_.size(); ++i) steps.push_back(times_ns_[i] - times_ns_[i - 1]);
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  if (*middle < kMinIntervalNs || *middle > kMaxIntervalNs)
    throw ConfigError(file + ": a picture every " + seconds(*middle) +
                      "; 0.001 to 10 s are expected: are the times in another unit?");
  return *middle;
}

}  // namespace rover::interchange
