// Checkpoint of SLAM: particles, frames, and the seen map cells after a mask of one bit per cell. The last POSE shows
// a correction that came during the restart. A jump candidate starts anew: the next cloud makes it again.
#include <cmath>

#include "common/core/state_bytes.hpp"
#include "slam/slam.hpp"

namespace rover::slam {
namespace {

constexpr std::uint32_t kVersion = 5;

bool is_finite_pose(const Pose2& pose) {
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.yaw_rad);
}

void put_pose(StateWriter& out, const Eigen::Isometry3d& T) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) out.put(T.matrix()(row, column));
}

Eigen::Isometry3d get_pose(StateReader& in) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) T.matrix()(row, column) = in.get<double>();
  return T;
}

void put_map(StateWriter& out, const GridMap<ElevationCell>& grid) {
  out.put(grid.cells());
  out.put(grid.origin());
  std::uint8_t mask = 0;
  int bits = 0;
  grid.for_each([&](CellIndex, const ElevationCell& cell) {
    mask = static_cast<std::uint8_t>(mask << 1 | (cell.seen() ? 1 : 0));
    if (++bits % 8 == 0) out.put(mask);
  });
  for (; bits % 8 != 0; ++bits) {
    mask = static_cast<std::uint8_t>(mask << 1);
    if (bits % 8 == 7) out.put(mask);
  }
  grid.for_each([&](CellIndex, const ElevationCell& cell) {
    if (!cell.seen()) return;
    out.put(cell.height_m);
    out.put(cell.top_m);
    out.put(cell.variance_m2);
    out.put(cell.seen_at_m);
    out.put(cell.outliers);
    out.put(cell.brightness);
  });
}

// False if the stored map has another size or invalid cells.
bool get_map(StateReader& in, GridMap<ElevationCell>& grid) {
  if (in.get<int>() != grid.cells()) return false;
  const CellIndex origin = in.get<CellIndex>();
  const CellIndex center{origin.ix + grid.cells() / 2, origin.iy + grid.cells() / 2};
  grid.move_to(grid.center_x_m(center), grid.center_y_m(center));
  std::vector<std::uint8_t> mask((static_cast<size_t>(grid.cells()) * grid.cells() + 7) / 8);
  for (std::uint8_t& byte : mask) byte = in.get<std::uint8_t>();
  size_t k = 0;
  bool valid = true;
  grid.for_each([&](CellIndex, ElevationCell& cell) {
    cell = ElevationCell{};
    const bool seen = (mask[k / 8] >> (7 - k % 8) & 1) != 0;
    ++k;
    if (!seen) return;
    cell.height_m = in.get<float>();
    cell.top_m = in.get<float>();
    cell.variance_m2 = in.get<float>();
    cell.seen_at_m = in.get<float>();
    cell.outliers = in.get<std::uint8_t>();
    cell.brightness = in.get<float>();
    valid = valid && std::isfinite(cell.height_m) && std::isfinite(cell.top_m) && cell.variance_m2 >= 0.0F &&
            std::isfinite(cell.seen_at_m) && !std::isinf(cell.brightness);
  });
  return valid;
}

}  // namespace

std::vector<std::uint8_t> Slam::save() const {
  StateWriter out;
  out.put(kVersion);
  out.put(utime_);
  put_pose(out, previous_.T_odom_body);
  out.put(previous_.position_sigma_m);
  out.put(previous_.yaw_sigma_rad);
  out.put(previous_.dead_reckoned_m);
  out.put(previous_.travelled_m);
  out.put(z_m_);
  out.put(travelled_m_);
  out.put(anchor_travelled_m_);
  out.put(gap_at_m_);
  out.put(static_cast<std::uint8_t>(gap_unmeasured_));
  out.put(match_error_.state());
  out.put(lost_count_);
  out.put(anchor_.state());
  out.put(static_cast<std::uint64_t>(filter_.particles().size()));
  for (const Particle& particle : filter_.particles()) out.put(particle);
  put_map(out, map_.grid());
  return out.take();
}

bool Slam::restore(const std::vector<std::uint8_t>& bytes) {
  StateReader in(bytes);
  if (in.get<std::uint32_t>() != kVersion) return false;
  Slam fresh(config_);
  fresh.utime_ = in.get<Utime>();
  fresh.previous_.T_odom_body = get_pose(in);
  fresh.previous_.position_sigma_m = in.get<double>();
  fresh.previous_.yaw_sigma_rad = in.get<double>();
  fresh.previous_.dead_reckoned_m = in.get<double>();
  fresh.previous_.travelled_m = in.get<double>();
  fresh.z_m_ = in.get<double>();
  fresh.travelled_m_ = in.get<double>();
  fresh.anchor_travelled_m_ = in.get<double>();
  fresh.gap_at_m_ = in.get<double>();
  fresh.gap_unmeasured_ = in.get<std::uint8_t>() != 0;
  const auto match_error = in.get<MatchError::State>();
  fresh.match_error_.restore(match_error);
  fresh.lost_count_ = in.get<int>();
  const auto anchor = in.get<MapAnchor::State>();
  fresh.anchor_.restore(anchor);
  std::vector<Particle> particles(in.count(sizeof(Particle)));
  bool valid = !particles.empty() && is_finite_pose(anchor.T_map_slam) && is_finite_pose(anchor.T_map_odom) &&
               is_finite(fresh.previous_.T_odom_body) && std::isfinite(fresh.previous_.dead_reckoned_m) &&
               std::isfinite(fresh.previous_.travelled_m) && std::isfinite(fresh.z_m_) &&
               is_finite_pose(match_error.bias) && match_error.bias_variance_m2 >= 0.0 && match_error.scatter >= 1.0;
  for (Particle& particle : particles) {
    particle = in.get<Particle>();
    valid = valid && is_finite_pose(particle.pose) && std::isfinite(particle.log_weight);
  }
  fresh.filter_.restore(std::move(particles));
  if (!get_map(in, fresh.map_.mutable_grid()) || !in.finished() || !valid) return false;
  *this = std::move(fresh);
  return true;
}

}  // namespace rover::slam
