#include "hazard_detector/cell_states.hpp"

#include <algorithm>

namespace rover::hazard {
namespace {

constexpr int kFewSamples = 20;  // of a cell, for which the count depends on where the image rows fall

class States {
 public:
  States(const std::vector<CellEvidence>& evidence, const GridShape& shape, const HazardConfig& config)
      : evidence_(evidence), shape_(shape), config_(config), cells_(evidence.size(), Cell::kUnseen) {}

  std::vector<Cell> make() {
    mark_ground();
    fill_single_gaps();
    mark_clusters(Cell::kObstacle, [](const CellEvidence& e) { return e.high; });
    mark_clusters(Cell::kHole, [](const CellEvidence& e) { return e.low; });
    grow_obstacles();
    mark_margin();
    return std::move(cells_);
  }

 private:
  template <class F>
  void for_neighbours(int cell, int reach, F&& f) const {
    const int ix = cell % shape_.cells_x, iy = cell / shape_.cells_x;
    for (int y = iy - reach; y <= iy + reach; ++y)
      for (int x = ix - reach; x <= ix + reach; ++x)
        if (shape_.contains(x, y) && (x != ix || y != iy)) f(shape_.at(x, y));
  }

  Cell& cell(int i) { return cells_[static_cast<size_t>(i)]; }
  const CellEvidence& evidence(int i) const { return evidence_[static_cast<size_t>(i)]; }
  bool hazard(int i) const {
    const Cell state = cells_[static_cast<size_t>(i)];
    return state == Cell::kObstacle || state == Cell::kHole;
  }

  bool ground_seen(int measured, int expected) const {
    return measured >= config_.min_free_samples && measured >= config_.free_share * expected;
  }

  // FREE needs measured ground in the cell: most of the samples that should see it must have. A rock without texture
  // and the ground behind any rock fail this and stay UNSEEN. Far cells have few image rows, so how many samples fall
  // into one is a matter of luck: such a cell counts together with its neighbours, but never without ground of its own.
  void mark_ground() {
    for (int i = 0; i < shape_.size(); ++i) {
      const CellEvidence& e = evidence(i);
      const int own = e.measured - e.high - e.low;
      int ground = own, expected = e.expected;
      if (own > 0 && !ground_seen(own, e.expected) && e.expected < kFewSamples)
        for_neighbours(i, 1, [&](int k) {
          ground += evidence(k).measured - evidence(k).high - evidence(k).low;
          expected += evidence(k).expected;
        });
      if (ground_seen(ground, expected)) cell(i) = Cell::kFree;
    }
  }

  // One unmeasured cell amid free ones cannot hide an obstacle: what stands T_near high hides more than one cell of
  // ground behind it, T_near / (h - T_near) times its distance.
  void fill_single_gaps() {
    std::vector<int> gaps;
    for (int i = 0; i < shape_.size(); ++i) {
      if (cell(i) == Cell::kFree) continue;
      int free = 0;
      for_neighbours(i, 1, [&](int k) { free += cell(k) == Cell::kFree; });
      if (free >= 7) gaps.push_back(i);
    }
    for (int i : gaps) cell(i) = Cell::kFree;
  }

  // Connected suspect cells are a hazard where they hold enough samples together; stereo's stray points are not.
  template <class Count>
  void mark_clusters(Cell state, Count&& count) {
    std::vector<char> visited(evidence_.size(), 0);
    const auto suspect = [&](int i) {
      return !visited[static_cast<size_t>(i)] && count(evidence(i)) >= config_.min_cell_samples;
    };
    for (int seed = 0; seed < shape_.size(); ++seed) {
      if (!suspect(seed)) continue;
      std::vector<int> cluster{seed};
      visited[static_cast<size_t>(seed)] = 1;
      int samples = 0;
      for (size_t k = 0; k < cluster.size(); ++k) {
        samples += count(evidence(cluster[k]));
        for_neighbours(cluster[k], 1, [&](int i) {
          if (!suspect(i)) return;
          visited[static_cast<size_t>(i)] = 1;
          cluster.push_back(i);
        });
      }
      if (samples < config_.min_cluster_samples) continue;
      for (int i : cluster) cell(i) = state;
    }
  }

  // The rock's flanks, below the limit themselves, belong to it.
  void grow_obstacles() {
    std::vector<int> flanks;
    for (int i = 0; i < shape_.size(); ++i) {
      if (cell(i) != Cell::kObstacle) continue;
      for_neighbours(i, 1, [&](int k) {
        if (!hazard(k) && evidence(k).raised >= config_.min_cell_samples) flanks.push_back(k);
      });
    }
    for (int i : flanks) cell(i) = Cell::kObstacle;
  }

  void mark_margin() {
    const int reach = static_cast<int>(std::ceil(config_.margin_m / shape_.cell_m - 1e-9));
    if (reach <= 0) return;
    std::vector<int> margin;
    for (int i = 0; i < shape_.size(); ++i)
      if (hazard(i)) for_neighbours(i, reach, [&](int k) { margin.push_back(k); });
    for (int i : margin)
      if (!hazard(i)) cell(i) = Cell::kMargin;
  }

  const std::vector<CellEvidence>& evidence_;
  const GridShape& shape_;
  const HazardConfig& config_;
  std::vector<Cell> cells_;
};

}  // namespace

std::vector<Cell> cell_states(const std::vector<CellEvidence>& evidence, const GridShape& shape,
                              const HazardConfig& config) {
  return States(evidence, shape, config).make();
}

}  // namespace rover::hazard
