#include "traversability/obstacles.hpp"

#include <cmath>

namespace rover::trav {
namespace {

constexpr double kRimShare = 1.0 / 3.0;  // of a cell, covered by the rock

struct Cell {
  int ix, iy;
};

template <class F>
void for_each_neighbour(const GridShape& shape, Cell p, F&& f) {
  for (int y = p.iy - 1; y <= p.iy + 1; ++y)
    for (int x = p.ix - 1; x <= p.ix + 1; ++x)
      if ((x != p.ix || y != p.iy) && shape.contains(x, y)) f(Cell{x, y});
}

template <class F>
void for_each_cell(const GridShape& shape, F&& f) {
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) f(Cell{ix, iy});
}

// Connected component of seen, obstacle-free cells, found by flood fill.
class ConnectedRegion {
 public:
  ConnectedRegion(const TerrainGrid& grid, const std::vector<std::uint8_t>& obstacle,
                  std::vector<std::uint8_t>& visited)
      : grid_(grid), obstacle_(obstacle), visited_(visited) {}

  void flood(Cell start) {
    visit(start);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const Cell p = cells_[k];
      const GridShape& shape = grid_.shape;
      touches_unknown_ =
          touches_unknown_ || p.ix == 0 || p.iy == 0 || p.ix == shape.cells_x - 1 || p.iy == shape.cells_y - 1;
      for_each_neighbour(shape, p, [&](Cell q) {
        touches_unknown_ = touches_unknown_ || std::isnan(grid_.height_m[shape.at(q.ix, q.iy)]);
        if (is_ground(q)) visit(q);
      });
    }
  }

  bool is_ground(Cell p) const {
    const std::size_t i = grid_.shape.at(p.ix, p.iy);
    return !visited_[i] && !obstacle_[i] && !std::isnan(grid_.height_m[i]);
  }
  bool enclosed() const { return !touches_unknown_; }
  const std::vector<Cell>& cells() const { return cells_; }

 private:
  void visit(Cell p) {
    visited_[grid_.shape.at(p.ix, p.iy)] = 1;
    cells_.push_back(p);
  }

  const TerrainGrid& grid_;
  const std::vector<std::uint8_t>& obstacle_;
  std::vector<std::uint8_t>& visited_;
  std::vector<Cell> cells_;
  bool touches_unknown_ = false;  // or the map's border
};

}  // namespace

std::vector<std::uint8_t> find_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                         const TraversabilityConfig& config) {
  const GridShape& shape = grid.shape;
  const double limit_m = config.step_limit_m(), grow_height_m = config.step.grow_height_m;
  std::vector<std::uint8_t> obstacle(shape.size(), 0);
  std::vector<Cell> queue;
  const auto mark = [&](Cell p) {
    obstacle[shape.at(p.ix, p.iy)] = 1;
    queue.push_back(p);
  };
  for_each_cell(shape, [&](Cell p) {
    const std::size_t i = shape.at(p.ix, p.iy);
    if (steps.rise_m[i] >= limit_m) mark(p);
  });
  // Region growing with a lower threshold adds sides and tops whose far side is unseen. The rim, which the rock covers
  // in part, and rises that may be noise are one cell more.
  for (std::size_t k = 0; k < queue.size(); ++k)
    for_each_neighbour(shape, queue[k], [&](Cell q) {
      const std::size_t i = shape.at(q.ix, q.iy);
      const bool raised = steps.rise_m[i] >= grow_height_m || grid.height_m[i] - planes.at(i).height_m >= limit_m;
      if (!obstacle[i] && raised) mark(q);
    });
  for (const Cell& p : queue)
    for_each_neighbour(shape, p, [&](Cell q) {
      const std::size_t i = shape.at(q.ix, q.iy);
      if (steps.raw_rise_m[i] >= kRimShare * limit_m) obstacle[i] = 1;
    });
  return obstacle;
}

void fill_enclosed_regions(const TerrainGrid& grid, double footprint_m2, std::vector<std::uint8_t>& obstacle) {
  const GridShape& shape = grid.shape;
  const double max_cells = footprint_m2 / (shape.cell_m * shape.cell_m);
  std::vector<std::uint8_t> visited(shape.size(), 0);
  for_each_cell(shape, [&](Cell p) {
    ConnectedRegion region(grid, obstacle, visited);
    if (!region.is_ground(p)) return;
    region.flood(p);
    if (!region.enclosed() || static_cast<double>(region.cells().size()) > max_cells) return;
    for (const Cell& q : region.cells()) obstacle[shape.at(q.ix, q.iy)] = 1;
  });
}

std::vector<std::uint8_t> find_low_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                             const std::vector<std::uint8_t>& obstacle,
                                             const TraversabilityConfig& config) {
  const GridShape& shape = grid.shape;
  std::vector<std::uint8_t> low(shape.size(), 0);
  std::vector<std::uint8_t> visited(shape.size(), 0);
  for_each_cell(shape, [&](Cell seed) {
    if (!obstacle[shape.at(seed.ix, seed.iy)] || visited[shape.at(seed.ix, seed.iy)]) return;
    std::vector<Cell> rock{seed};
    visited[shape.at(seed.ix, seed.iy)] = 1;
    bool is_low = true;
    for (std::size_t k = 0; k < rock.size(); ++k) {
      const std::size_t i = shape.at(rock[k].ix, rock[k].iy);
      // The rise is that over the lowest of many cells, which noise lowers.
      const double noise_m = config.step.significance * grid.sigma_m[i];
      is_low = is_low && grid.height_m[i] - planes.at(i).height_m < config.body_limit_m() &&
               steps.raw_rise_m[i] - noise_m < config.body_limit_m();
      for_each_neighbour(shape, rock[k], [&](Cell q) {
        const std::size_t j = shape.at(q.ix, q.iy);
        if (!obstacle[j] || visited[j]) return;
        visited[j] = 1;
        rock.push_back(q);
      });
    }
    if (!is_low) return;
    for (const Cell& p : rock) low[shape.at(p.ix, p.iy)] = 1;
  });
  return low;
}

}  // namespace rover::trav
