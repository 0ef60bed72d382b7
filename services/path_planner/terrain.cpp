#include "path_planner/terrain.hpp"

#include <array>

#include "common/core/distance_field.hpp"

namespace rover::planning {
namespace {

// A single unseen cell among seen ones hides nothing that matters: a hazard 0.15 m tall is wider than one cell of 0.1
// m.
constexpr int kNeighboursThatFill = 6;

constexpr double kWheelsReachM = 0.45;  // to the sides of the rover's centre

constexpr double kRelaxM = 0.02;  // leaves room for rounding where the rover stands close to a hazard

// Marks unseen cells that are enough surrounded by seen ones as seen.
std::vector<std::uint8_t> closed(const std::vector<std::uint8_t>& unseen, int cells) {
  std::vector<std::uint8_t> out = unseen;
  for (int y = 1; y + 1 < cells; ++y)
    for (int x = 1; x + 1 < cells; ++x) {
      const size_t i = static_cast<size_t>(y) * cells + x;
      if (!unseen[i]) continue;
      const auto row = [&](size_t j) { return unseen[j - 1] + unseen[j] + unseen[j + 1]; };
      if (9 - row(i - cells) - row(i) - row(i + cells) >= kNeighboursThatFill) out[i] = 0;
    }
  return out;
}

// Ground that was seen from afar and is blind from near is trusted as long as it is narrow: only where the camera sees
// hardly anything over half a metre could it miss what lies there.
constexpr int kWideCells = 5;
constexpr int kWideCount = 20;  // of 25

std::vector<std::uint8_t> wide_parts(const std::vector<std::uint8_t>& mask, int cells) {
  const int n = cells + 1;
  std::vector<int> sum(static_cast<size_t>(n) * n, 0);
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x)
      sum[(y + 1) * n + x + 1] = mask[y * cells + x] + sum[y * n + x + 1] + sum[(y + 1) * n + x] - sum[y * n + x];
  std::vector<std::uint8_t> out(mask.size(), 0);
  for (int y = 0; y + kWideCells <= cells; ++y)
    for (int x = 0; x + kWideCells <= cells; ++x) {
      const int x1 = x + kWideCells;
      const int y1 = y + kWideCells;
      if (sum[y1 * n + x1] - sum[y * n + x1] - sum[y1 * n + x] + sum[y * n + x] < kWideCount) continue;
      for (int v = y; v < y1; ++v)
        for (int u = x; u < x1; ++u) out[v * cells + u] = mask[v * cells + u];
    }
  return out;
}

// The largest value within so many cells, along rows and columns.
std::vector<float> widened(const std::vector<float>& values, int cells, int reach) {
  const auto along = [&](const std::vector<float>& in, int step, int across) {
    std::vector<float> out(in.size());
    for (int line = 0; line < cells; ++line)
      for (int k = 0; k < cells; ++k) {
        float most = 0.0F;
        for (int j = std::max(0, k - reach); j <= std::min(cells - 1, k + reach); ++j)
          most = std::max(most, in[line * across + j * step]);
        out[line * across + k * step] = most;
      }
    return out;
  };
  return along(along(values, 1, cells), cells, 1);
}

}  // namespace

Terrain::Terrain(const HazardMemory& memory, const GroundMap* ground, Reach reach, const Doubt& doubt)
    : cells_(reach == Reach::kGround ? ground->map().cells() : memory.map().cells()),
      cell_m_(memory.map().cell_m()),
      cells_per_m_(1.0 / cell_m_),
      side_m_(cells_ * cell_m_) {
  const CellIndex origin = reach == Reach::kGround ? ground->map().origin() : memory.map().origin();
  corner_ = {origin.ix * cell_m_, origin.iy * cell_m_};
  const auto for_each_cell = [&](auto&& f) {
    for (int iy = origin.iy; iy < origin.iy + cells_; ++iy)
      for (int ix = origin.ix; ix < origin.ix + cells_; ++ix) f(CellIndex{ix, iy}, memory.map().get({ix, iy}));
  };
  unseen_.reserve(static_cast<size_t>(cells_) * cells_);
  std::vector<std::uint8_t> blind;
  blind.reserve(unseen_.capacity());
  for_each_cell([&](CellIndex, const GroundCell& cell) { blind.push_back(memory.blind(cell) ? 1 : 0); });
  const std::vector<std::uint8_t> widely_blind = wide_parts(blind, cells_);
  for_each_cell([&](CellIndex, const GroundCell& cell) {
    unseen_.push_back(cell.seen && !widely_blind[unseen_.size()] ? 0 : 1);
  });
  unseen_ = closed(unseen_, cells_);
  std::vector<std::uint8_t> impassable(unseen_.size(), 0);
  if (ground != nullptr) {
    impassable = lay_ground(memory, *ground, origin);
    unseen_ = closed(unseen_, cells_);
  }
  if (doubt.most_cells > 0) {
    std::vector<std::uint8_t> sure;
    sure.reserve(unseen_.size());
    for_each_cell([&](CellIndex i, const GroundCell& cell) {
      const bool from_near = ground != nullptr && ground->map().get(i).range_m <= doubt.from_m;
      sure.push_back(cell.hits > 0 || from_near || (doubt.if_seen_free && cell.near_free == 0) ? 1 : 0);
    });
    drop_doubtful(doubt, sure, impassable);
  }
  std::vector<std::uint8_t> hazard;
  hazard.reserve(unseen_.size());
  for_each_cell([&](CellIndex i, const GroundCell& cell) {
    const bool stays_unseen = unseen_[hazard.size()] != 0 && blind[hazard.size()] != 0;
    const bool certain = stays_unseen || impassable[hazard.size()] != 0;
    const bool is_hazard = cell.hits > 0 || certain;
    if (hazard.size() % cells_ == 0) row_begin_.push_back(hazards_.size());
    if (is_hazard)
      hazards_.push_back({{memory.map().center_x_m(i), memory.map().center_y_m(i)}, certain || memory.confirmed(cell)});
    hazard.push_back(is_hazard ? 1 : 0);
  });
  row_begin_.push_back(hazards_.size());
  hazard_distance_ = distance_field(hazard, cells_, cells_, cell_m_);
  unseen_distance_ = distance_field(unseen_, cells_, cells_, cell_m_);
}

std::vector<std::uint8_t> Terrain::lay_ground(const HazardMemory& memory, const GroundMap& ground, CellIndex origin) {
  std::vector<std::uint8_t> impassable(unseen_.size(), 0);
  difficulty_.assign(unseen_.size(), 0.0F);
  for (size_t i = 0; i < unseen_.size(); ++i) {
    const int cell = static_cast<int>(i);
    const CellIndex index{origin.ix + cell % cells_, origin.iy + cell / cells_};
    std::uint8_t cost = ground.map().get(index).cost;
    if (cost == TraversabilityGrid::kUnknown) continue;
    unseen_[i] = 0;
    if (memory.refutes(memory.map().get(index))) cost = std::min(cost, TraversabilityGrid::kRefuted);
    impassable[i] = cost == TraversabilityGrid::kImpassable ? 1 : 0;
    difficulty_[i] = static_cast<float>(cost) / static_cast<float>(TraversabilityGrid::kImpassable);
  }
  difficulty_ = widened(difficulty_, cells_, static_cast<int>(kWheelsReachM / cell_m_));
  return impassable;
}

void Terrain::drop_doubtful(const Doubt& doubt, const std::vector<std::uint8_t>& sure,
                            std::vector<std::uint8_t>& mask) const {
  std::vector<std::uint8_t> visited(mask.size(), 0);
  std::vector<int> spot;
  const auto visit = [&](int cell) {
    if (mask[cell] == 0 || visited[cell] != 0) return;
    visited[cell] = 1;
    spot.push_back(cell);
  };
  for (int first = 0; first < static_cast<int>(mask.size()); ++first) {
    spot.clear();
    visit(first);
    for (size_t k = 0; k < spot.size(); ++k) {
      const int x0 = spot[k] % cells_, y0 = spot[k] / cells_;
      for (int y = std::max(0, y0 - 1); y <= std::min(cells_ - 1, y0 + 1); ++y)
        for (int x = std::max(0, x0 - 1); x <= std::min(cells_ - 1, x0 + 1); ++x) visit(y * cells_ + x);
    }
    const bool small = static_cast<int>(spot.size()) <= doubt.most_cells;
    const bool doubtful = small && std::none_of(spot.begin(), spot.end(), [&](int cell) {
                            return sure[cell] != 0 || distance(center_of(cell), doubt.rover) < doubt.from_m;
                          });
    if (!doubtful) continue;
    for (const int cell : spot) mask[cell] = 0;
  }
}

std::span<const HazardSpot> Terrain::hazards_about(Point2 p, double reach_m) const {
  const auto row = [&](double y_m) {
    return std::clamp(static_cast<int>(std::floor((y_m - corner_.y_m) * cells_per_m_)), 0, cells_ - 1);
  };
  const size_t begin = row_begin_[row(p.y_m - reach_m)];
  return {hazards_.data() + begin, row_begin_[row(p.y_m + reach_m) + 1] - begin};
}

Point2 Terrain::center_of(int cell) const {
  return {corner_.x_m + (cell % cells_ + 0.5) * cell_m_, corner_.y_m + (cell / cells_ + 0.5) * cell_m_};
}

double Terrain::hazard_distance_smooth(Point2 p, Eigen::Vector2d& gradient) const {
  constexpr double kMost = 5.0;
  gradient.setZero();
  const double gx = (p.x_m - corner_.x_m) / cell_m_ - 0.5;
  const double gy = (p.y_m - corner_.y_m) / cell_m_ - 0.5;
  if (!(gx >= 0.0 && gy >= 0.0 && gx < cells_ - 1 && gy < cells_ - 1)) return kMost;
  const int ix = static_cast<int>(gx);
  const int iy = static_cast<int>(gy);
  const auto at = [&](int x, int y) { return std::min(hazard_distance_[static_cast<size_t>(y) * cells_ + x], kMost); };
  const double u = gx - ix;
  const double v = gy - iy;
  const double a = at(ix, iy);
  const double b = at(ix + 1, iy);
  const double c = at(ix, iy + 1);
  const double d = at(ix + 1, iy + 1);
  gradient = Eigen::Vector2d((1.0 - v) * (b - a) + v * (d - c), (1.0 - u) * (c - a) + u * (d - b)) / cell_m_;
  return (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
}

FootprintCheck::FootprintCheck(const Terrain& terrain, const Footprint& footprint, double margin_m,
                               double seen_margin_m, const Pose2& start)
    : terrain_(terrain), footprint_(footprint), margin_m_(margin_m), start_(start) {
  const double x = footprint.half_length_m + seen_margin_m;
  const double y = footprint.half_width_m + seen_margin_m;
  const int nx = static_cast<int>(std::ceil(2.0 * x / terrain.cell_m()));
  const int ny = static_cast<int>(std::ceil(2.0 * y / terrain.cell_m()));
  for (int i = 0; i < ny; ++i) rim_.push_back({x, y * (2.0 * i / ny - 1.0)});
  for (int i = 0; i < nx; ++i) rim_.push_back({x * (1.0 - 2.0 * i / nx), y});
  for (int i = 0; i < ny; ++i) rim_.push_back({-x, y * (1.0 - 2.0 * i / ny)});
  for (int i = 0; i < nx; ++i) rim_.push_back({x * (2.0 * i / nx - 1.0), -y});
}

bool FootprintCheck::violates(const Pose2& pose, Point2 hazard) const {
  const double d = footprint_.distance_m(pose, hazard);
  if (d >= margin_m_) return false;
  const double at_start = footprint_.distance_m(start_, hazard);
  return d < std::min(margin_m_, std::max(at_start - kRelaxM, 0.0));
}

bool FootprintCheck::clear(const Pose2& pose) const {
  const double reach = footprint_.radius_m() + margin_m_;
  if (terrain_.hazard_distance_m(position(pose)) > reach + terrain_.cell_m()) return true;
  const std::span<const HazardSpot> near = terrain_.hazards_about(position(pose), reach);
  return std::none_of(near.begin(), near.end(), [&](const HazardSpot& h) {
    return std::abs(h.p.x_m - pose.x_m) <= reach && std::abs(h.p.y_m - pose.y_m) <= reach && violates(pose, h.p);
  });
}

bool FootprintCheck::clear_of(const Pose2& pose, bool confirmed) const {
  const double reach = footprint_.radius_m() + margin_m_;
  if (terrain_.hazard_distance_m(position(pose)) > reach + terrain_.cell_m()) return true;
  const std::span<const HazardSpot> near = terrain_.hazards_about(position(pose), reach);
  return std::none_of(near.begin(), near.end(), [&](const HazardSpot& h) {
    return h.confirmed == confirmed && std::abs(h.p.x_m - pose.x_m) <= reach && violates(pose, h.p);
  });
}

double FootprintCheck::clearance_m(const Pose2& pose, double most) const {
  double least = most;
  for (const HazardSpot& h : terrain_.hazards()) least = std::min(least, footprint_.distance_m(pose, h.p));
  return least;
}

}  // namespace rover::planning
