#include "common/core/fast_marching.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/core/frames.hpp"

namespace rover {
namespace {

class Front {
 public:
  explicit Front(const MarchGrid& grid)
      : grid_(grid), travel_(grid.cost_per_m.size(), kInfinity), accepted_(grid.cost_per_m.size(), 0) {}

  void offer(int cell, double travel_cost) {
    if (travel_cost >= travel_[cell] || std::isinf(grid_.cost_per_m[cell])) return;
    travel_[cell] = travel_cost;
    heap_.emplace_back(travel_cost, cell);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  // The next cell of the front; -1 if it is empty.
  int accept() {
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const int cell = heap_.back().second;
      heap_.pop_back();
      if (accepted_[cell]) continue;
      accepted_[cell] = 1;
      return cell;
    }
    return -1;
  }

  void spread(int cell) {
    const int x = cell % grid_.width;
    const int y = cell / grid_.width;
    if (x > 0) update(cell - 1);
    if (x + 1 < grid_.width) update(cell + 1);
    if (y > 0) update(cell - grid_.width);
    if (y + 1 < grid_.height) update(cell + grid_.width);
  }

  double travel(int cell) const { return travel_[cell]; }

  std::vector<double> result() && {
    for (size_t i = 0; i < travel_.size(); ++i)
      if (!accepted_[i]) travel_[i] = kInfinity;
    return std::move(travel_);
  }

 private:
  double known(int cell) const { return accepted_[cell] ? travel_[cell] : kInfinity; }

  // Upwind solution of (T - a)^2 + (T - b)^2 = (h c)^2 with the smaller neighbour on each axis.
  void update(int cell) {
    if (accepted_[cell]) return;
    const int x = cell % grid_.width;
    const int y = cell / grid_.width;
    const double a = std::min(x > 0 ? known(cell - 1) : kInfinity, x + 1 < grid_.width ? known(cell + 1) : kInfinity);
    const double b = std::min(y > 0 ? known(cell - grid_.width) : kInfinity,
                              y + 1 < grid_.height ? known(cell + grid_.width) : kInfinity);
    const double step = grid_.cell_m * grid_.cost_per_m[cell];
    const double low = std::min(a, b);
    const double high = std::max(a, b);
    const bool one_sided = high - low >= step;  // also where high is infinite
    offer(cell,
          one_sided ? low + step : 0.5 * (low + high + std::sqrt(2.0 * step * step - (high - low) * (high - low))));
  }

  const MarchGrid& grid_;
  std::vector<double> travel_;
  std::vector<std::uint8_t> accepted_;
  std::vector<std::pair<double, int>> heap_;
};

}  // namespace

std::vector<double> march(const MarchGrid& grid, const std::vector<Seed>& seeds, int target, double beyond) {
  Front front(grid);
  for (const Seed& seed : seeds) front.offer(seed.cell, seed.travel_cost);
  double limit = kInfinity;
  for (int cell = front.accept(); cell >= 0 && front.travel(cell) <= limit; cell = front.accept()) {
    if (cell == target) limit = front.travel(cell) + beyond;
    front.spread(cell);
  }
  return std::move(front).result();
}

}  // namespace rover
