#include "slam/match_surface.hpp"

namespace rover::slam {

MatchSurface::MatchSurface(const ElevationMap& map, double z_m, double travelled_m)
    : cells_(map.grid().cells()),
      cell_m_(map.grid().cell_m()),
      limit_(static_cast<float>(cells_ - 1)),
      corner_(map.grid().origin()) {
  const size_t size = static_cast<size_t>(cells_) * cells_;
  height_m_.reserve(size);
  variance_m2_.reserve(size);
  map.grid().for_each([&](CellIndex, const ElevationCell& cell) {
    height_m_.push_back(cell.seen() ? cell.height_m - static_cast<float>(z_m)
                                    : std::numeric_limits<float>::quiet_NaN());
    variance_m2_.push_back(map.variance_m2(cell, travelled_m));
  });
}

std::optional<MatchSurface::Sample> MatchSurface::sample(float x, float y) const {
  const float h = height(x, y);
  if (std::isnan(h)) return std::nullopt;
  const int i = static_cast<int>(x - 0.5F), j = static_cast<int>(y - 0.5F);
  const size_t k = static_cast<size_t>(j) * cells_ + i, up = k + cells_;
  const auto per_m = static_cast<float>(0.5 / cell_m_);
  const float slope_x = (height_m_[k + 1] + height_m_[up + 1] - height_m_[k] - height_m_[up]) * per_m;
  const float slope_y = (height_m_[up] + height_m_[up + 1] - height_m_[k] - height_m_[k + 1]) * per_m;
  const float variance = 0.25F * (variance_m2_[k] + variance_m2_[k + 1] + variance_m2_[up] + variance_m2_[up + 1]);
  return Sample{h, slope_x, slope_y, variance};
}

}  // namespace rover::slam
