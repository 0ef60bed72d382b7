#include "tools/campaign/page/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>

#include "common/core/frames.hpp"

namespace rover::campaign {
namespace {

constexpr size_t kMaxExact = 60;
constexpr size_t kResamples = 2000;
constexpr size_t kMinSeeds = 5;
constexpr std::uint64_t kRandomSeed = 28;

// Correlation of the paired outcomes with Newcombe's continuity correction.
double corrected_phi(const PairedCounts& c) {
  const double a = c.both;
  const double b = c.only_b;
  const double d = c.neither;
  const double e = c.only_a;
  const double product = (a + b) * (e + d) * (a + e) * (b + d);
  if (product == 0.0) return 0.0;
  const double determinant = a * d - b * e;
  const double half = 0.5 * c.pairs();
  const double corrected = determinant > half ? determinant - half : std::min(determinant, 0.0);
  return corrected / std::sqrt(product);
}

// Square root of the squares' sum of two correlated distances.
double combined(double x, double y, double phi) {
  return std::sqrt(std::max(0.0, x * x - 2.0 * phi * x * y + y * y));
}

// Twice the mean rank of each absolute value: whole numbers even where values tie. The values are sorted.
std::vector<int> doubled_ranks(const std::vector<double>& sorted) {
  std::vector<int> ranks(sorted.size());
  for (size_t i = 0; i < sorted.size();) {
    size_t j = i;
    while (j < sorted.size() && std::abs(sorted[j]) == std::abs(sorted[i])) ++j;
    std::fill(ranks.begin() + static_cast<long>(i), ranks.begin() + static_cast<long>(j), static_cast<int>(i + j + 1));
    i = j;
  }
  return ranks;
}

// P(rank sum at most `limit`) if each sign is equally likely.
double exact_tail(const std::vector<int>& ranks, int limit) {
  std::vector<double> probability(static_cast<size_t>(std::accumulate(ranks.begin(), ranks.end(), 0)) + 1, 0.0);
  probability[0] = 1.0;
  for (const int rank : ranks)
    for (size_t sum = probability.size(); sum-- > 0;)
      probability[sum] = 0.5 * (probability[sum] + (sum >= static_cast<size_t>(rank) ? probability[sum - rank] : 0.0));
  return std::accumulate(probability.begin(), probability.begin() + limit + 1, 0.0);
}

double normal_p(const std::vector<int>& ranks, int positive) {
  const double half_sum = 0.5 * std::accumulate(ranks.begin(), ranks.end(), 0.0);
  double variance = 0.0;
  for (const int rank : ranks) variance += 0.25 * rank * rank;
  constexpr double kContinuity = 1.0;  // half a rank, doubled
  const double z = std::max(0.0, std::abs(positive - half_sum) - kContinuity) / std::sqrt(variance);
  return std::erfc(z / std::sqrt(2.0));
}

// A value, and the number of its seed from 0.
struct Member {
  double value;
  size_t seed;
};

std::vector<Member> members_of(const std::vector<SeedValue>& values) {
  std::map<std::int64_t, size_t> numbers;
  std::vector<Member> members;
  for (const SeedValue& v : values) members.push_back({v.value, numbers.emplace(v.seed, numbers.size()).first->second});
  return members;
}

size_t seed_count(const std::vector<Member>& members) {
  size_t count = 0;
  for (const Member& member : members) count = std::max(count, member.seed + 1);
  return count;
}

// Interval of a statistic over samples in which each seed occurs so many times.
Interval resampled(size_t seeds, const std::function<double(const std::vector<int>&)>& statistic) {
  if (seeds < kMinSeeds) return {kNaN, kNaN};
  std::mt19937_64 random(kRandomSeed);
  std::vector<double> results;
  for (size_t i = 0; i < kResamples; ++i) {
    std::vector<int> times(seeds, 0);
    for (size_t k = 0; k < seeds; ++k) ++times[random() % seeds];
    results.push_back(statistic(times));
  }
  std::sort(results.begin(), results.end());
  return {quantile(results, 0.025), quantile(results, 0.975)};
}

// Median of sorted values, each repeated as often as its seed occurs; `total` with the repetitions.
double repeated_median(const std::vector<Member>& sorted, const std::vector<int>& times, int total) {
  const int lower = (total - 1) / 2;
  const int upper = total / 2;
  double low = kNaN;
  int before = 0;
  for (const Member& member : sorted) {
    const int after = before + times[member.seed];
    if (before <= lower && lower < after) low = member.value;
    if (upper < after) return 0.5 * (low + member.value);
    before = after;
  }
  return kNaN;
}

}  // namespace

Interval newcombe_paired(const PairedCounts& c) {
  if (c.pairs() == 0) return {kNaN, kNaN};
  const double p_a = static_cast<double>(c.both + c.only_a) / c.pairs();
  const double p_b = static_cast<double>(c.both + c.only_b) / c.pairs();
  const Interval of_a = wilson(c.both + c.only_a, c.pairs());
  const Interval of_b = wilson(c.both + c.only_b, c.pairs());
  const double phi = corrected_phi(c);
  return {p_b - p_a - combined(p_b - of_b.low, of_a.high - p_a, phi),
          p_b - p_a + combined(p_a - of_a.low, of_b.high - p_b, phi)};
}

double mcnemar_exact_p(const PairedCounts& c) {
  const int changed = c.only_a + c.only_b;
  if (changed == 0) return 1.0;
  const boost::math::binomial_distribution<double> chance(changed, 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(chance, std::min(c.only_a, c.only_b)));
}

double signed_rank_p(std::vector<double> differences) {
  std::erase_if(differences, [](double d) { return d == 0.0 || !std::isfinite(d); });
  if (differences.empty()) return 1.0;
  std::sort(differences.begin(), differences.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const std::vector<int> ranks = doubled_ranks(differences);
  int positive = 0;
  for (size_t i = 0; i < ranks.size(); ++i) positive += differences[i] > 0.0 ? ranks[i] : 0;
  if (ranks.size() > kMaxExact) return normal_p(ranks, positive);
  const int total = std::accumulate(ranks.begin(), ranks.end(), 0);
  return std::min(1.0, 2.0 * exact_tail(ranks, std::min(positive, total - positive)));
}

std::vector<double> benjamini_hochberg(const std::vector<double>& p_values) {
  std::vector<size_t> order;
  for (size_t i = 0; i < p_values.size(); ++i)
    if (std::isfinite(p_values[i])) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size(), kNaN);
  double lowest = 1.0;
  for (size_t rank = order.size(); rank > 0; --rank) {
    const size_t i = order[rank - 1];
    lowest = std::min(lowest, p_values[i] * static_cast<double>(order.size()) / static_cast<double>(rank));
    adjusted[i] = lowest;
  }
  return adjusted;
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return kNaN;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Interval bootstrap_mean(const std::vector<SeedValue>& values) {
  const std::vector<Member> members = members_of(values);
  std::vector<double> sums(seed_count(members), 0.0);
  std::vector<double> sizes(sums.size(), 0.0);
  for (const Member& member : members) {
    sums[member.seed] += member.value;
    sizes[member.seed] += 1.0;
  }
  return resampled(sums.size(), [&](const std::vector<int>& times) {
    const auto weighted = [&](const std::vector<double>& of_seed) {
      return std::inner_product(times.begin(), times.end(), of_seed.begin(), 0.0);
    };
    return weighted(sums) / weighted(sizes);
  });
}

Interval bootstrap_median(const std::vector<SeedValue>& values) {
  std::vector<Member> members = members_of(values);
  std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.value < b.value; });
  std::vector<int> sizes(seed_count(members), 0);
  for (const Member& member : members) ++sizes[member.seed];
  return resampled(sizes.size(), [&](const std::vector<int>& times) {
    return repeated_median(members, times, std::inner_product(times.begin(), times.end(), sizes.begin(), 0));
  });
}

}  // namespace rover::campaign
