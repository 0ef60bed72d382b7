#include "hazard_detector/cell_classifier.hpp"

#include <algorithm>

namespace rover::hazard {
namespace {

constexpr int kSparseCellSamples = 20;  // fewer expected samples: the count depends on where image rows fall

class CellClassifier {
 public:
  CellClassifier(const std::vector<CellEvidence>& evidence, const GridShape& shape, const HazardConfig& config)
      : evidence_(evidence), shape_(shape), config_(config), cells_(evidence.size(), Cell::kUnseen) {}

  std::vector<Cell> classify() {
    mark_free();
    fill_single_gaps();
    mark_clusters(Cell::kObstacle, [](const CellEvidence& e) { return e.high; });
    mark_clusters(Cell::kHole, [](const CellEvidence& e) { return e.low; });
    grow_obstacles();
    find_low_obstacles();
    inflate_hazards();
    return std::move(cells_);
  }

 private:
  template <class F>
  void for_neighbours(int cell, int radius, F&& f) const {
    const int ix = cell % shape_.cells_x, iy = cell / shape_.cells_x;
    for (int y = iy - radius; y <= iy + radius; ++y)
      for (int x = ix - radius; x <= ix + radius; ++x)
        if (shape_.contains(x, y) && (x != ix || y != iy)) f(shape_.at(x, y));
  }

  Cell& cell(int i) { return cells_[static_cast<size_t>(i)]; }
  const CellEvidence& evidence(int i) const { return evidence_[static_cast<size_t>(i)]; }
  bool hazard(int i) const { return is_hazard(cells_[static_cast<size_t>(i)]); }

  bool enough_ground(int measured, int expected) const {
    return measured >= config_.min_free_samples && measured >= config_.min_free_fraction * expected;
  }

  // For each distance the samples of a cell that is whole in the picture: the most. Of a cell with less than half of
  // them most lies beyond the picture's rim, where a rock may stand.
  std::vector<int> expected_of_whole_cells() const {
    std::vector<int> most(static_cast<size_t>(shape_.cells_x), 0);
    for (int i = 0; i < shape_.size(); ++i) {
      int& expected = most[static_cast<size_t>(i % shape_.cells_x)];
      expected = std::max(expected, evidence(i).expected);
    }
    return most;
  }

  // FREE needs most expected samples on ground: textureless rocks and occluded ground stay UNSEEN. Sparse far cells
  // count together with their neighbours, but need at least one ground sample of their own.
  void mark_free() {
    const std::vector<int> whole = expected_of_whole_cells();
    for (int i = 0; i < shape_.size(); ++i) {
      if (2 * evidence(i).expected < whole[static_cast<size_t>(i % shape_.cells_x)]) continue;
      const CellEvidence& e = evidence(i);
      const int own_ground = e.measured - e.high - e.low;
      int ground = own_ground, expected = e.expected;
      if (own_ground > 0 && !enough_ground(own_ground, e.expected) && e.expected < kSparseCellSamples)
        for_neighbours(i, 1, [&](int k) {
          ground += evidence(k).measured - evidence(k).high - evidence(k).low;
          expected += evidence(k).expected;
        });
      if (enough_ground(ground, expected)) cell(i) = Cell::kFree;
    }
  }

  // One unmeasured cell among free ones cannot hide an obstacle: an obstacle of height T_near occludes more than one
  // cell of ground behind it, T_near / (h - T_near) times its distance.
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

  // The cells connected with the seed by those that `accepts` takes; marks them as visited.
  template <class Accepts>
  std::vector<int> connected(int seed, Accepts&& accepts, std::vector<char>& visited) const {
    std::vector<int> cells{seed};
    visited[static_cast<size_t>(seed)] = 1;
    for (size_t k = 0; k < cells.size(); ++k)
      for_neighbours(cells[k], 1, [&](int i) {
        if (!accepts(i)) return;
        visited[static_cast<size_t>(i)] = 1;
        cells.push_back(i);
      });
    return cells;
  }

  // Connected components of suspect cells are hazards if they contain enough samples; this rejects stereo outliers.
  template <class Count>
  void mark_clusters(Cell state, Count&& count) {
    std::vector<char> visited(evidence_.size(), 0);
    const auto is_suspect = [&](int i) {
      return !visited[static_cast<size_t>(i)] && count(evidence(i)) >= config_.min_cell_samples;
    };
    for (int seed = 0; seed < shape_.size(); ++seed) {
      if (!is_suspect(seed)) continue;
      int samples = 0;
      const std::vector<int> cluster = connected(seed, is_suspect, visited);
      for (int i : cluster) samples += count(evidence(i));
      if (samples < config_.min_cluster_samples) continue;
      for (int i : cluster) cell(i) = state;
    }
  }

  // Region growing: the lower sides of a rock are part of the obstacle.
  void grow_obstacles() {
    std::vector<int> sides;
    for (int i = 0; i < shape_.size(); ++i) {
      if (cell(i) != Cell::kObstacle) continue;
      for_neighbours(i, 1, [&](int k) {
        if (!hazard(k) && evidence(k).raised >= config_.min_cell_samples) sides.push_back(k);
      });
    }
    for (int i : sides) cell(i) = Cell::kObstacle;
  }

  // A rock as a whole is low or not. It is low if it was seen to be: most rays that pass over it at the height of the
  // body are measured, and what they meet is not tall.
  void find_low_obstacles() {
    std::vector<char> visited(evidence_.size(), 0);
    const auto is_open = [&](int i) { return cell(i) == Cell::kObstacle && !visited[static_cast<size_t>(i)]; };
    for (int seed = 0; seed < shape_.size(); ++seed) {
      if (!is_open(seed)) continue;
      int tall = 0, over = 0, over_seen = 0;
      const std::vector<int> rock = connected(seed, is_open, visited);
      for (int i : rock) {
        tall += evidence(i).tall;
        over += evidence(i).over;
        over_seen += evidence(i).over_seen;
      }
      const bool top_seen = over > 0 && over_seen >= config_.min_free_fraction * over;
      if (tall >= config_.min_cell_samples || !top_seen) continue;
      for (int i : rock) cell(i) = Cell::kLow;
    }
  }

  void inflate_hazards() {
    const int radius = static_cast<int>(std::ceil(config_.margin_m / shape_.cell_m - 1e-9));
    if (radius <= 0) return;
    std::vector<int> margin;
    for (int i = 0; i < shape_.size(); ++i)
      if (hazard(i)) for_neighbours(i, radius, [&](int k) { margin.push_back(k); });
    for (int i : margin)
      if (cell(i) == Cell::kFree) cell(i) = Cell::kMargin;
  }

  const std::vector<CellEvidence>& evidence_;
  const GridShape& shape_;
  const HazardConfig& config_;
  std::vector<Cell> cells_;
};

}  // namespace

std::vector<Cell> classify_cells(const std::vector<CellEvidence>& evidence, const GridShape& shape,
                                 const HazardConfig& config) {
  return CellClassifier(evidence, shape, config).classify();
}

}  // namespace rover::hazard
