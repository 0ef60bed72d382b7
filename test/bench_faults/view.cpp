#include "test/bench_faults/view.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/frames.hpp"
#include "test/stereo/synthetic_world.hpp"

namespace rover::bench_faults {
namespace {

constexpr double kLeastDepthM = 0.3;

std::int16_t in_px16(double disparity_px) {
  return static_cast<std::int16_t>(std::max(1.0, std::round(16.0 * disparity_px)));
}

// Evenly distributed over the image.
bool is_measured(size_t pixel, double share) {
  return static_cast<double>((pixel * 2654435761u >> 8) % 1000) < 1000.0 * share;
}

}  // namespace

View::View(const StereoCamera& camera, double ground_z_m)
    : camera_(camera), ground_z_m_(ground_z_m), ground_(camera.width, camera.height) {
  synthetic::World flat;
  flat.z0_m = ground_z_m;
  const std::vector<float> exact = synthetic::exact_disparity(flat, camera);
  for (size_t i = 0; i < exact.size(); ++i)
    if (exact[i] > 0.0f) ground_.px16[i] = in_px16(exact[i]);
}

Disparity View::look(const std::vector<Rock>& rocks, double share) const {
  Disparity disparity = ground_;
  for (const Rock& rock : rocks) draw(rock, disparity);
  if (share < 1.0)
    for (size_t i = 0; i < disparity.px16.size(); ++i)
      if (!is_measured(i, share)) disparity.px16[i] = Disparity::kInvalid;
  return disparity;
}

// Casts rays in the image rectangle of the rock's bounding box.
void View::draw(const Rock& rock, Disparity& disparity) const {
  double low_u = camera_.width, high_u = 0.0, low_v = camera_.height, high_v = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const double x_m = rock.p.x_m + (corner & 1 ? rock.radius_m : -rock.radius_m);
    const double y_m = rock.p.y_m + (corner & 2 ? rock.radius_m : -rock.radius_m);
    const double z_m = ground_z_m_ + (corner & 4 ? rock.height_m : 0.0);
    const Eigen::Vector3d p_cam = camera_.T_body_cam.inverse() * Eigen::Vector3d(x_m, y_m, z_m);
    if (p_cam.z() < kLeastDepthM) return;
    const double u = camera_.cx_px + camera_.focal_px * p_cam.x() / p_cam.z();
    const double v = camera_.cy_px + camera_.focal_px * p_cam.y() / p_cam.z();
    low_u = std::min(low_u, u), high_u = std::max(high_u, u);
    low_v = std::min(low_v, v), high_v = std::max(high_v, v);
  }
  synthetic::World world;
  world.z0_m = ground_z_m_;
  world.rocks = {{rock.p.x_m, rock.p.y_m, rock.radius_m, rock.height_m}};
  const int to_u = std::min(camera_.width - 1, static_cast<int>(high_u));
  const int to_v = std::min(camera_.height - 1, static_cast<int>(high_v));
  for (int v = std::max(0, static_cast<int>(low_v)); v <= to_v; ++v)
    for (int u = std::max(0, static_cast<int>(low_u)); u <= to_u; ++u) {
      const Eigen::Vector3d ray =
          camera_.T_body_cam.linear() * camera_.point(u, v, camera_.focal_px * camera_.baseline_m);
      const synthetic::Hit hit = synthetic::cast(world, camera_.T_body_cam.translation(), ray);
      if (hit.rock == 0) disparity.at(u, v) = in_px16(camera_.focal_px * camera_.baseline_m / hit.t);
    }
}

}  // namespace rover::bench_faults
