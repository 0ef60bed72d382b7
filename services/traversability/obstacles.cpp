#include "traversability/obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace rover::trav {
namespace {

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

// The component of cells that `accepts` takes, by flood fill from the seed, which is one.
template <class F>
std::vector<Cell> connected(const GridShape& shape, Cell seed, std::vector<std::uint8_t>& visited, F&& accepts) {
  std::vector<Cell> cells{seed};
  visited[shape.at(seed.ix, seed.iy)] = 1;
  for (std::size_t k = 0; k < cells.size(); ++k)
    for_each_neighbour(shape, cells[k], [&](Cell q) {
      if (visited[shape.at(q.ix, q.iy)] || !accepts(q)) return;
      visited[shape.at(q.ix, q.iy)] = 1;
      cells.push_back(q);
    });
  return cells;
}

// Unseen cells, or what lies outside of the map.
bool touches_unknown(const TerrainGrid& grid, Cell p) {
  const GridShape& shape = grid.shape;
  bool touches = p.ix == 0 || p.iy == 0 || p.ix == shape.cells_x - 1 || p.iy == shape.cells_y - 1;
  for_each_neighbour(shape, p, [&](Cell q) { touches = touches || std::isnan(grid.height_m[shape.at(q.ix, q.iy)]); });
  return touches;
}

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
      if (steps.raw_rise_m[i] >= config.step.rim_fraction * limit_m) obstacle[i] = 1;
    });
  return obstacle;
}

void fill_enclosed_regions(const TerrainGrid& grid, double footprint_m2, std::vector<std::uint8_t>& obstacle) {
  const GridShape& shape = grid.shape;
  const double max_cells = footprint_m2 / (shape.cell_m * shape.cell_m);
  std::vector<std::uint8_t> visited(shape.size(), 0);
  const auto is_ground = [&](Cell p) {
    return !obstacle[shape.at(p.ix, p.iy)] && !std::isnan(grid.height_m[shape.at(p.ix, p.iy)]);
  };
  for_each_cell(shape, [&](Cell p) {
    if (visited[shape.at(p.ix, p.iy)] || !is_ground(p)) return;
    const std::vector<Cell> region = connected(shape, p, visited, is_ground);
    if (static_cast<double>(region.size()) > max_cells) return;
    if (std::any_of(region.begin(), region.end(), [&](Cell q) { return touches_unknown(grid, q); })) return;
    for (const Cell& q : region) obstacle[shape.at(q.ix, q.iy)] = 1;
  });
}

std::vector<std::uint8_t> find_low_obstacles(const TerrainGrid& grid, const DiscPlanes& planes, const Steps& steps,
                                             const std::vector<std::uint8_t>& obstacle,
                                             const TraversabilityConfig& config) {
  const GridShape& shape = grid.shape;
  std::vector<std::uint8_t> low(shape.size(), 0);
  std::vector<std::uint8_t> visited(shape.size(), 0);
  const auto is_obstacle = [&](Cell p) { return obstacle[shape.at(p.ix, p.iy)] != 0; };
  const auto passes_under_body = [&](Cell p) {
    const std::size_t i = shape.at(p.ix, p.iy);
    // The rise is that over the lowest of many cells, which noise lowers.
    const double noise_m = config.step.significance * grid.sigma_m[i];
    return grid.height_m[i] - planes.at(i).height_m < config.body_limit_m() &&
           steps.raw_rise_m[i] - noise_m < config.body_limit_m();
  };
  for_each_cell(shape, [&](Cell seed) {
    if (visited[shape.at(seed.ix, seed.iy)] || !is_obstacle(seed)) return;
    const std::vector<Cell> rock = connected(shape, seed, visited, is_obstacle);
    if (!std::all_of(rock.begin(), rock.end(), passes_under_body)) return;
    for (const Cell& p : rock) low[shape.at(p.ix, p.iy)] = 1;
  });
  return low;
}

}  // namespace rover::trav
