#include "traversability/obstacles.hpp"

#include <cmath>

namespace rover::trav {
namespace {

struct Place {
  int ix, iy;
};

template <class F>
void for_neighbours(const GridShape& shape, Place p, F&& f) {
  for (int y = p.iy - 1; y <= p.iy + 1; ++y)
    for (int x = p.ix - 1; x <= p.ix + 1; ++x)
      if ((x != p.ix || y != p.iy) && shape.contains(x, y)) f(Place{x, y});
}

template <class F>
void for_cells(const GridShape& shape, F&& f) {
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) f(Place{ix, iy});
}

// One piece of ground that is neither unseen nor obstacle, found by flooding.
class Island {
 public:
  Island(const TerrainGrid& grid, const std::vector<std::uint8_t>& obstacle, std::vector<std::uint8_t>& visited)
      : grid_(grid), obstacle_(obstacle), visited_(visited) {}

  void flood(Place start) {
    visit(start);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const Place p = cells_[k];
      const GridShape& shape = grid_.shape;
      open_ = open_ || p.ix == 0 || p.iy == 0 || p.ix == shape.cells_x - 1 || p.iy == shape.cells_y - 1;
      for_neighbours(shape, p, [&](Place q) {
        open_ = open_ || std::isnan(grid_.height_m[shape.at(q.ix, q.iy)]);
        if (ground(q)) visit(q);
      });
    }
  }

  bool ground(Place p) const {
    const std::size_t i = grid_.shape.at(p.ix, p.iy);
    return !visited_[i] && !obstacle_[i] && !std::isnan(grid_.height_m[i]);
  }
  bool enclosed() const { return !open_; }
  const std::vector<Place>& cells() const { return cells_; }

 private:
  void visit(Place p) {
    visited_[grid_.shape.at(p.ix, p.iy)] = 1;
    cells_.push_back(p);
  }

  const TerrainGrid& grid_;
  const std::vector<std::uint8_t>& obstacle_;
  std::vector<std::uint8_t>& visited_;
  std::vector<Place> cells_;
  bool open_ = false;  // touches the unseen or the map's border
};

}  // namespace

std::vector<std::uint8_t> find_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                         const TraversabilityConfig& config) {
  const GridShape& shape = grid.shape;
  const double limit_m = config.step_limit_m(), foot_m = config.step.foot_m;
  std::vector<std::uint8_t> obstacle(shape.size(), 0);
  std::vector<Place> front;
  const auto mark = [&](Place p) {
    obstacle[shape.at(p.ix, p.iy)] = 1;
    front.push_back(p);
  };
  for_cells(shape, [&](Place p) {
    const std::size_t i = shape.at(p.ix, p.iy);
    if (steps.rise_m[i] >= limit_m || steps.drop_m[i] >= limit_m) mark(p);
  });
  // Beside an obstacle less is enough: foot and flanks, and tops whose far side was not seen. Not beyond one cell where
  // the rise may be noise.
  for (std::size_t k = 0; k < front.size(); ++k)
    for_neighbours(shape, front[k], [&](Place q) {
      const std::size_t i = shape.at(q.ix, q.iy);
      const bool raised = steps.rise_m[i] >= foot_m || grid.height_m[i] - planes.at(i).height_m >= limit_m;
      if (!obstacle[i] && raised) mark(q);
    });
  for (const Place& p : front)
    for_neighbours(shape, p, [&](Place q) {
      const std::size_t i = shape.at(q.ix, q.iy);
      if (steps.uncertain_rise_m[i] >= foot_m) obstacle[i] = 1;
    });
  return obstacle;
}

void close_islands(const TerrainGrid& grid, double footprint_m2, std::vector<std::uint8_t>& obstacle) {
  const GridShape& shape = grid.shape;
  const double max_cells = footprint_m2 / (shape.cell_m * shape.cell_m);
  std::vector<std::uint8_t> visited(shape.size(), 0);
  for_cells(shape, [&](Place p) {
    Island island(grid, obstacle, visited);
    if (!island.ground(p)) return;
    island.flood(p);
    if (!island.enclosed() || static_cast<double>(island.cells().size()) > max_cells) return;
    for (const Place& q : island.cells()) obstacle[shape.at(q.ix, q.iy)] = 1;
  });
}

}  // namespace rover::trav
