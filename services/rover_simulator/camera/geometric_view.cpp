#include "rover_simulator/camera/geometric_view.hpp"

#include <algorithm>
#include <cmath>

namespace rover {
namespace {

constexpr float kMinContrast = 0.03F;  // below it blocks have no unique match

TileSceneConfig unshaded() {
  TileSceneConfig config;
  config.threads = 1;
  config.shaded = false;
  return config;
}

}  // namespace

GeometricView::GeometricView(const Surface& world, const GroundAppearanceConfig& appearance)
    : world_(world), appearance_(appearance), scene_(std::make_shared<TileScene>(world, unshaded())) {}

Disparity GeometricView::expose(GeometricStereo& stereo, const DisparityErrors& errors, const DisparityPlane& reference,
                                const Eigen::Isometry3d& T_map_left, std::int64_t frame) {
  const std::vector<float> exact_px = stereo.exact_px(T_map_left);
  const auto px_at = [&](int u, int v) { return exact_px[static_cast<size_t>(v) * stereo.width() + u]; };
  const auto rock_at = [&](int u, int v) {
    if (px_at(u, v) <= 0.0F) return -1;
    const Eigen::Vector3d p_map = T_map_left * stereo.point(u, v, px_at(u, v));
    return world_.material(p_map.x(), p_map.y()).rock_id;
  };
  // The outline of a rock matches, whatever covers it.
  const auto is_outline = [&](int u, int v) {
    constexpr int kStep = DisparityErrors::kTexturePx;
    const int left = std::max(u - kStep, 0), right = std::min(u + kStep, stereo.width() - 1);
    const int above = std::max(v - kStep, 0), below = std::min(v + kStep, stereo.height() - 1);
    const int rock = rock_at(u, v);
    return rock_at(left, v) != rock || rock_at(right, v) != rock || rock_at(u, above) != rock ||
           rock_at(u, below) != rock;
  };
  const auto has_texture = [&](int u, int v) {
    if (px_at(u, v) <= 0.0F) return true;
    return textured(T_map_left * stereo.point(u, v, px_at(u, v))) || is_outline(u, v);
  };
  return errors.apply(exact_px, has_texture, reference, frame);
}

bool GeometricView::textured(const Eigen::Vector3d& p_map) const {
  const Material material = world_.material(p_map.x(), p_map.y());
  return appearance_.at(p_map.x(), p_map.y(), material).fine_contrast >= kMinContrast;
}

DisparityErrorConfig errors_of(const stereo::MatcherConfig& matcher, const StereoCamera& rectified) {
  DisparityErrorConfig config;
  config.baseline_m = static_cast<float>(rectified.baseline_m);
  config.search_min_px = static_cast<float>(matcher.residual_min_px);
  config.search_max_px = static_cast<float>(matcher.residual_min_px + matcher.residual_count_px - 1);
  return config;
}

DisparityPlane ground_reference(const StereoCamera& rectified, double origin_height_m) {
  return disparity_plane(rectified, {0, 0, -origin_height_m}, Eigen::Vector3d::UnitZ());
}

}  // namespace rover
