#include "rover_simulator/camera/calibration_error.hpp"

#include <cmath>

#include "common/core/check.hpp"
#include "common/core/frames.hpp"
#include "rover_simulator/camera/counter_hash.hpp"
#include "rover_simulator/camera/ray_table.hpp"

namespace rover {
namespace {

constexpr std::uint64_t kCalibrationSalt = 0xCA11B4A7E0ULL;
constexpr std::uint64_t kMountingSalt = 0x3047E4401ULL;

class Normals {
 public:
  Normals(std::uint64_t seed, std::uint64_t salt) : key_(hash64(seed, salt)) {}
  double next() {
    const std::uint64_t h = hash64(key_, ++counter_);
    return static_cast<double>(near_normal(static_cast<std::uint32_t>(h), static_cast<std::uint32_t>(h >> 32)));
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

// Nine parameters, scaled to pixels at the image border so that all have equal weight.
struct Perturbation {
  double focal_left, cx_left, cy_left, focal_right, cx_right, cy_right, yaw, pitch, roll;
};

Perturbation draw(std::uint64_t seed) {
  Normals normals(seed, kCalibrationSalt);
  Perturbation p{};
  for (double* value :
       {&p.focal_left, &p.cx_left, &p.cy_left, &p.focal_right, &p.cx_right, &p.cy_right, &p.yaw, &p.pitch, &p.roll})
    *value = normals.next();
  return p;
}

void perturb(PinholeCamera& camera, double half_width_px, double focal, double cx, double cy) {
  const double scale = 1.0 + focal / half_width_px;
  camera.fx_px *= scale;
  camera.fy_px *= scale;
  camera.cx_px += cx;
  camera.cy_px += cy;
}

StereoRig apply(const StereoRig& nominal, const Perturbation& p, double scale) {
  StereoRig rig = nominal;
  const double half_width = 0.5 * nominal.width;
  perturb(rig.left, half_width, scale * p.focal_left, scale * p.cx_left, scale * p.cy_left);
  perturb(rig.right, half_width, scale * p.focal_right, scale * p.cx_right, scale * p.cy_right);
  const double f = nominal.right.fx_px;
  const Eigen::Vector3d rotation(scale * p.pitch / f, scale * p.yaw / f, scale * p.roll / half_width);
  rig.T_left_right.linear() = nominal.T_left_right.linear() * exp_so3(rotation);
  return rig;
}

double squared_error_sum(const PinholeCamera& a, const PinholeCamera& b, const Eigen::Matrix3d& R_b_a, int width,
                         int height, int& count) {
  double sum = 0.0;
  for (int v = 0; v < height; v += 16) {
    for (int u = 0; u < width; u += 16) {
      const Eigen::Vector2d pixel(u, v);
      sum += (project(b, R_b_a * ray_of_pixel(a, pixel)) - pixel).squaredNorm();
      ++count;
    }
  }
  return sum;
}

}  // namespace

double reprojection_rms_px(const StereoRig& a, const StereoRig& b) {
  int count = 0;
  double sum = squared_error_sum(a.left, b.left, Eigen::Matrix3d::Identity(), a.width, a.height, count);
  const Eigen::Matrix3d R_b_a = b.T_left_right.linear().transpose() * a.T_left_right.linear();
  sum += squared_error_sum(a.right, b.right, R_b_a, a.width, a.height, count);
  return std::sqrt(sum / count);
}

StereoRig with_calibration_error(const StereoRig& nominal, double error_px, std::uint64_t seed) {
  ROVER_CHECK(error_px >= 0.0, error_px);
  if (error_px == 0.0) return nominal;
  const Perturbation p = draw(seed);
  double scale = error_px;
  // The error is almost linear in the scale; two corrections are enough.
  for (int i = 0; i < 2; ++i) scale *= error_px / reprojection_rms_px(nominal, apply(nominal, p, scale));
  return apply(nominal, p, scale);
}

StereoRig with_mounting_error(const StereoRig& nominal, double sigma_rad, std::uint64_t seed) {
  ROVER_CHECK(sigma_rad >= 0.0, sigma_rad);
  Normals normals(seed, kMountingSalt);
  Eigen::Vector3d turn_rad;
  for (double& angle_rad : turn_rad) angle_rad = sigma_rad * normals.next();
  StereoRig rig = nominal;
  rig.T_body_left.linear() = exp_so3(turn_rad) * nominal.T_body_left.linear();
  return rig;
}

}  // namespace rover
