#include "test/stereo/synthetic_world.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "common/core/frames.hpp"

namespace rover::synthetic {
namespace {

using Eigen::Vector3d;

double hit_ground(const World& w, const Vector3d& o, const Vector3d& d) {
  const double climb = d.z() - w.slope_x * d.x() - w.slope_y * d.y();
  const double above = o.z() - w.plane_m(o.x(), o.y());
  double t = climb < 0.0 ? -above / climb : kInfinity;
  if (!w.relief || !std::isfinite(t)) return t;
  // First intersection with the relief: ray marching, then bisection.
  const auto over = [&](double s) { return o.z() + s * d.z() - w.ground_m(o.x() + s * d.x(), o.y() + s * d.y()); };
  double low = 0.3 * t;
  const double step = 0.01 * t;
  for (double high = low + step; high < 3.0 * t; low = high, high += step) {
    if (over(high) > 0.0) continue;
    for (int i = 0; i < 20; ++i) (over(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
    return high;
  }
  return kInfinity;
}

double hit_ellipsoid(const Rock& rock, double base, const Vector3d& o, const Vector3d& d) {
  const Vector3d scale(1.0 / rock.half_width_m, 1.0 / rock.half_width_m, 1.0 / rock.height_m);
  const Vector3d p = (o - Vector3d(rock.x_m, rock.y_m, base)).cwiseProduct(scale), q = d.cwiseProduct(scale);
  const double b = p.dot(q), a = q.squaredNorm(), c = p.squaredNorm() - 1.0;
  const double root = b * b - a * c;
  return root < 0.0 ? kInfinity : (-b - std::sqrt(root)) / a;
}

// Entry and exit of the ray in the box.
std::pair<double, double> slab(const Vector3d& low, const Vector3d& high, const Vector3d& o, const Vector3d& d) {
  double enter = 0.0, leave = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const double a = (low[i] - o[i]) / d[i], b = (high[i] - o[i]) / d[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

double hit_rock(const World& w, const Rock& rock, const Vector3d& o, const Vector3d& d) {
  const double base = w.ground_m(rock.x_m, rock.y_m);
  if (!rock.box) return hit_ellipsoid(rock, base, o, d);
  const Vector3d half(rock.half_width_m, rock.half_width_m, 0.0), foot(rock.x_m, rock.y_m, base - 0.3);
  const auto [enter, leave] = slab(foot - half, foot + half + Vector3d(0, 0, rock.height_m + 0.3), o, d);
  return enter < leave ? enter : kInfinity;
}

// A ray over a pit continues to its wall or floor.
double through_pits(const World& w, const Vector3d& o, const Vector3d& d, double t) {
  for (const Pit& pit : w.pits) {
    const Vector3d p = o + t * d;
    if (std::abs(p.x() - pit.x_m) >= pit.half_width_m || std::abs(p.y() - pit.y_m) >= pit.half_width_m) continue;
    const double top = w.ground_m(pit.x_m, pit.y_m);
    const Vector3d half(pit.half_width_m, pit.half_width_m, 0.0), middle(pit.x_m, pit.y_m, top);
    return slab(middle - half - Vector3d(0, 0, pit.depth_m), middle + half + Vector3d(0, 0, 10.0), o, d).second;
  }
  return t;
}

Vector3d ray_in_body(const StereoCamera& camera, double u, double v) {
  return camera.T_body_cam.linear() *
         Vector3d((u - camera.cx_px) / camera.focal_px, (v - camera.cy_px) / camera.focal_px, 1.0);
}

double lattice(int i, int j, std::uint64_t salt) {
  std::uint64_t h = salt + 0x9E3779B97F4A7C15ull * static_cast<std::uint32_t>(i) +
                    0xC2B2AE3D27D4EB4Full * static_cast<std::uint32_t>(j);
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-53 - 0.5;
}

// Value noise in [-0.5, 0.5] with smooth interpolation.
double value_noise(double x, double y, std::uint64_t salt) {
  const double fx = std::floor(x), fy = std::floor(y);
  const int i = static_cast<int>(fx), j = static_cast<int>(fy);
  const auto smooth = [](double s) { return s * s * (3.0 - 2.0 * s); };
  const double u = smooth(x - fx), v = smooth(y - fy);
  return (1 - v) * ((1 - u) * lattice(i, j, salt) + u * lattice(i + 1, j, salt)) +
         v * ((1 - u) * lattice(i, j + 1, salt) + u * lattice(i + 1, j + 1, salt));
}

// Brightness of a surface point, band-limited to two pixels against aliasing.
double brightness(const Vector3d& p, double pixel_m, std::uint64_t seed) {
  double grey = 120.0;
  std::uint64_t salt = seed * 7919;
  for (double wave_m = 0.004; wave_m < 0.5; wave_m *= 2.2, ++salt)
    if (wave_m > 1.5 * pixel_m)
      grey += 45.0 * value_noise((p.x() + 0.6 * p.z()) / wave_m, (p.y() + 0.8 * p.z()) / wave_m, salt);
  return grey;
}

GrayImage render_one(const World& world, const PinholeCamera& camera, const Eigen::Isometry3d& T_body_cam, int width,
                     int height, double sigma_grey, std::uint64_t texture, std::mt19937_64& random) {
  std::vector<cv::Point2d> pixels, rays;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) pixels.emplace_back(u, v);
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const std::vector<double> D(camera.distortion.begin(), camera.distortion.end());
  cv::undistortPoints(pixels, rays, K, D, cv::noArray(), cv::noArray(),
                      cv::TermCriteria(cv::TermCriteria::COUNT, 20, 0));
  std::normal_distribution<double> noise(0.0, sigma_grey);
  GrayImage image(width, height);
  for (size_t i = 0; i < rays.size(); ++i) {
    const Vector3d d = T_body_cam.linear() * Vector3d(rays[i].x, rays[i].y, 1.0);
    const Hit hit = cast(world, T_body_cam.translation(), d);
    double grey = 90.0;
    if (std::isfinite(hit.t) && (hit.rock < 0 || !world.rocks[static_cast<size_t>(hit.rock)].textureless))
      grey = brightness(T_body_cam.translation() + hit.t * d, hit.t / camera.fx_px, texture);
    image.data[i] = static_cast<std::uint8_t>(std::clamp(std::lround(grey + noise(random)), 0l, 255l));
  }
  return image;
}

}  // namespace

Hit cast(const World& world, const Vector3d& o, const Vector3d& d) {
  Hit hit{through_pits(world, o, d, hit_ground(world, o, d)), -1};
  for (size_t i = 0; i < world.rocks.size(); ++i) {
    const double t = hit_rock(world, world.rocks[i], o, d);
    if (t > 0.0 && t < hit.t) hit = {t, static_cast<int>(i)};
  }
  return hit;
}

std::vector<float> exact_disparity(const World& world, const StereoCamera& camera) {
  std::vector<float> exact;
  exact.reserve(static_cast<size_t>(camera.width) * camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Hit hit = cast(world, camera.T_body_cam.translation(), ray_in_body(camera, u, v));
      const bool seen =
          std::isfinite(hit.t) && (hit.rock < 0 || !world.rocks[static_cast<size_t>(hit.rock)].textureless);
      const double d = seen ? camera.focal_px * camera.baseline_m / hit.t : 0.0;
      exact.push_back(u - d >= 0.0 ? static_cast<float>(d) : 0.0f);  // else out of the right image
    }
  return exact;
}

Disparity noisy_disparity(const std::vector<float>& exact, const StereoCamera& camera, double sigma_px, double drop,
                          std::mt19937_64& random) {
  std::normal_distribution<float> noise(0.0f, static_cast<float>(sigma_px));
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Disparity disparity(camera.width, camera.height);
  for (size_t i = 0; i < exact.size(); ++i) {
    if (exact[i] <= 0.0f || (drop > 0.0 && uniform(random) < drop)) continue;
    disparity.px16[i] = static_cast<std::int16_t>(std::max(1.0f, std::round(16.0f * (exact[i] + noise(random)))));
  }
  return disparity;
}

RawPair render(const World& world, const StereoRig& rig, double sigma_grey, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Eigen::Isometry3d T_body_right = rig.T_body_left * rig.T_left_right;
  return {render_one(world, rig.left, rig.T_body_left, rig.width, rig.height, sigma_grey, seed, random),
          render_one(world, rig.right, T_body_right, rig.width, rig.height, sigma_grey, seed, random)};
}

StereoRig loccam_rig() {
  StereoRig rig;
  rig.width = 512;
  rig.height = 384;
  rig.left = {417.5, 417.5, 257.3, 190.6, {-0.081, 0.043, 0.0004, -0.0003, 0.0}};
  rig.right = {417.9, 417.9, 254.8, 192.2, {-0.079, 0.041, -0.0002, 0.0005, 0.0}};
  rig.T_left_right = make_pose(rotation_from_rpy(to_rad(0.11), to_rad(-0.15), to_rad(0.08)), {0.12, 0.0003, -0.0002});
  rig.T_body_left = make_pose(camera_rotation(to_rad(33.0)), {0.527, 0.074, 0.059});
  return rig;
}

StereoCamera loccam_camera() {
  return {512, 384, 417.5, 255.5, 191.5, 0.12, make_pose(camera_rotation(to_rad(33.0)), {0.527, 0.074, 0.059})};
}

}  // namespace rover::synthetic
