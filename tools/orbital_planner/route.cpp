#include "tools/orbital_planner/route.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/frames.hpp"

namespace rover::orbital {
namespace {

using Eigen::Vector2d;

constexpr double kDescentStep = 0.5;  // cells
constexpr double kCheckStep = 0.25;   // cells, between the checked points of a straight segment

Vector2d center_of(const MarchGrid& grid, int cell) {
  return {(cell % grid.width + 0.5) * grid.cell_m, (cell / grid.width + 0.5) * grid.cell_m};
}

// Gradient descent on the cost-to-go.
class Descent {
 public:
  Descent(const MarchGrid& grid, const std::vector<double>& travel) : grid_(grid), travel_(travel) {}

  Line walk(const Vector2d& start, const Vector2d& goal) const {
    Line line{start};
    // The path does not revisit cells, so this bound only stops an endless loop.
    const size_t max_points = 8 * travel_.size() + 16;
    while (!arrives(line.back(), goal) && line.size() < max_points) step(line);
    line.push_back(goal);
    return line;
  }

 private:
  double travel(int x, int y) const {
    const bool inside = x >= 0 && y >= 0 && x < grid_.width && y < grid_.height;
    return inside ? travel_[static_cast<size_t>(y) * grid_.width + x] : kInfinity;
  }

  bool arrives(const Vector2d& p, const Vector2d& goal) const {
    return cell_at(grid_, p) == cell_at(grid_, goal) || ((p - goal).norm() <= grid_.cell_m && is_open(grid_, p, goal));
  }

  // Half a cell along the gradient if the cost-to-go decreases, else to the centre of the best neighbour cell.
  void step(Line& line) const {
    const Vector2d p = line.back();
    const int cell = cell_at(grid_, p);
    const Vector2d descent = descent_at(p);
    if (descent.norm() > 0.0) {
      const Vector2d q = p + kDescentStep * grid_.cell_m * descent.normalized();
      if (is_open(grid_, p, q) && falls(p, cell, q, cell_at(grid_, q))) return line.push_back(q);
    }
    line.push_back(center_of(grid_, cell));
    line.push_back(center_of(grid_, best_neighbour(cell)));
  }

  bool falls(const Vector2d& from, int from_cell, const Vector2d& to, int to_cell) const {
    return to_cell == from_cell ? interpolated(to) < interpolated(from) : travel_[to_cell] < travel_[from_cell];
  }

  int best_neighbour(int cell) const {
    const int x = cell % grid_.width, y = cell / grid_.width;
    int best = cell;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        // Diagonal moves only between traversable cells.
        if (std::isinf(travel(x + dx, y + dy)) || std::isinf(travel(x + dx, y)) || std::isinf(travel(x, y + dy)))
          continue;
        const int neighbour = (y + dy) * grid_.width + x + dx;
        if (travel_[neighbour] < travel_[best]) best = neighbour;
      }
    return best;
  }

  struct Corner {
    int x, y;
    double weight;
  };
  // The four cells around a point with their bilinear weights.
  std::array<Corner, 4> corners(const Vector2d& p) const {
    const double px = p.x() / grid_.cell_m - 0.5, py = p.y() / grid_.cell_m - 0.5;
    const int x = static_cast<int>(std::floor(px)), y = static_cast<int>(std::floor(py));
    const double u = px - x, v = py - y;
    return {{{x, y, (1 - u) * (1 - v)}, {x + 1, y, u * (1 - v)}, {x, y + 1, (1 - u) * v}, {x + 1, y + 1, u * v}}};
  }

  // Only over cells with a finite cost-to-go.
  double interpolated(const Vector2d& p) const {
    double sum = 0.0, weights = 0.0;
    for (const Corner& c : corners(p))
      if (const double t = travel(c.x, c.y); std::isfinite(t)) sum += c.weight * t, weights += c.weight;
    return weights > 0.0 ? sum / weights : kInfinity;
  }

  Vector2d descent_at(const Vector2d& p) const {
    Vector2d sum = Vector2d::Zero();
    for (const Corner& c : corners(p))
      if (std::isfinite(travel(c.x, c.y))) sum += c.weight * Vector2d(descent_along(c, 1, 0), descent_along(c, 0, 1));
    return sum;
  }

  // Upwind difference, as in the fast marching update.
  double descent_along(const Corner& c, int dx, int dy) const {
    const double here = travel(c.x, c.y);
    const double behind = travel(c.x - dx, c.y - dy), ahead = travel(c.x + dx, c.y + dy);
    if (std::min(behind, ahead) >= here) return 0.0;
    return ahead < behind ? here - ahead : behind - here;
  }

  const MarchGrid& grid_;
  const std::vector<double>& travel_;
};

}  // namespace

int cell_at(const MarchGrid& grid, const Vector2d& p) {
  const double x = std::floor(p.x() / grid.cell_m), y = std::floor(p.y() / grid.cell_m);
  if (!(x >= 0.0 && y >= 0.0 && x < grid.width && y < grid.height)) return -1;
  return static_cast<int>(y) * grid.width + static_cast<int>(x);
}

double cost_at(const MarchGrid& grid, const Vector2d& p) {
  const int cell = cell_at(grid, p);
  return cell < 0 ? kInfinity : grid.cost_per_m[cell];
}

bool is_open(const MarchGrid& grid, const Vector2d& a, const Vector2d& b) {
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / (kCheckStep * grid.cell_m))));
  for (int i = 0; i <= steps; ++i)
    if (std::isinf(cost_at(grid, a + (b - a) * i / steps))) return false;
  return true;
}

std::optional<Line> minimum_cost_path(const MarchGrid& grid, const Vector2d& start, const Vector2d& goal) {
  const int from = cell_at(grid, start);
  // The descent reads neighbours of the path's cells, so the front must have passed them too.
  const double beyond = 4.0 * grid.cell_m * cost_at(grid, start);
  const std::vector<double> travel = march(grid, {{cell_at(grid, goal), 0.0}}, from, beyond);
  if (std::isinf(travel[from])) return std::nullopt;
  return Descent(grid, travel).walk(start, goal);
}

double length_m(std::span<const Vector2d> line) {
  double length = 0.0;
  for (size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

Line resampled(const Line& line, double spacing_m, const MarchGrid& grid) {
  const double length = length_m(line);
  const int parts = std::max(1, static_cast<int>(std::lround(length / spacing_m)));
  Line points{line.front()};
  double passed = 0.0;  // arc length up to the vertex before `next`
  size_t next = 1;
  for (int k = 1; k <= parts; ++k) {
    const double wanted = length * k / parts;
    const size_t first = next;
    while (next + 1 < line.size() && passed + (line[next] - line[next - 1]).norm() < wanted) {
      passed += (line[next] - line[next - 1]).norm();
      ++next;
    }
    const double piece = (line[next] - line[next - 1]).norm();
    const double fraction = piece > 0.0 ? std::min(1.0, (wanted - passed) / piece) : 0.0;
    const Vector2d p = k == parts ? line.back() : Vector2d(line[next - 1] + (line[next] - line[next - 1]) * fraction);
    // The chord is blocked: use the line's own vertices.
    if (!is_open(grid, points.back(), p)) points.insert(points.end(), line.begin() + first, line.begin() + next);
    points.push_back(p);
  }
  return points;
}

Line smoothed(Line line, const MarchGrid& grid, const RouteConfig& config) {
  // A step with weight 1/2 is a binomial filter of variance 1/2 spacing^2 along the line.
  const double sigma_points = config.smoothing_sigma_m / config.point_spacing_m;
  const int rounds = static_cast<int>(std::ceil(2.0 * sigma_points * sigma_points));
  for (int round = 0; round < rounds; ++round) {
    const Line before = line;
    for (size_t i = 1; i + 1 < line.size(); ++i) {
      const Vector2d moved = 0.5 * before[i] + 0.25 * (before[i - 1] + before[i + 1]);
      if (is_open(grid, line[i - 1], moved) && is_open(grid, moved, before[i + 1])) line[i] = moved;
    }
  }
  return line;
}

}  // namespace rover::orbital
