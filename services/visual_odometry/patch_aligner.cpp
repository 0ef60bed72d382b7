#include "visual_odometry/patch_aligner.hpp"

#include <Eigen/LU>
#include <cmath>

namespace rover::vo {
namespace {

constexpr int kMaxIterations = 12;
constexpr float kConvergedPx = 0.01F;
// Standard deviation of grey values below which the camera noise dominates.
constexpr float kMinContrast = 1.5F;
constexpr int kBorderSide = kPatchSide + 2;  // with a border of one pixel for central differences

using Window = std::array<float, kPatchArea>;

bool inside(const cv::Mat& image, const Eigen::Vector2f& p, float margin) {
  return p.x() >= margin && p.y() >= margin && p.x() < static_cast<float>(image.cols - 1) - margin &&
         p.y() < static_cast<float>(image.rows - 1) - margin;
}

float bilinear(const cv::Mat& image, float x, float y) {
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  const float a = x - static_cast<float>(ix);
  const float b = y - static_cast<float>(iy);
  const uchar* r0 = image.ptr<uchar>(iy) + ix;
  const uchar* r1 = image.ptr<uchar>(iy + 1) + ix;
  return (1 - b) * ((1 - a) * static_cast<float>(r0[0]) + a * static_cast<float>(r0[1])) +
         b * ((1 - a) * static_cast<float>(r1[0]) + a * static_cast<float>(r1[1]));
}

// Axis-aligned window: all pixels share the bilinear weights, so the loop vectorises.
void sample_axis_aligned(const cv::Mat& image, const Eigen::Vector2f& center, Window& out) {
  const float x = center.x() - kPatchRadius;
  const float y = center.y() - kPatchRadius;
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  const float a = x - static_cast<float>(ix);
  const float b = y - static_cast<float>(iy);
  const float w00 = (1 - a) * (1 - b);
  const float w01 = a * (1 - b);
  const float w10 = (1 - a) * b;
  const float w11 = a * b;
  for (int r = 0; r < kPatchSide; ++r) {
    const uchar* r0 = image.ptr<uchar>(iy + r) + ix;
    const uchar* r1 = image.ptr<uchar>(iy + r + 1) + ix;
    float* row = out.data() + r * kPatchSide;
    for (int c = 0; c < kPatchSide; ++c)
      row[c] = w00 * static_cast<float>(r0[c]) + w01 * static_cast<float>(r0[c + 1]) + w10 * static_cast<float>(r1[c]) +
               w11 * static_cast<float>(r1[c + 1]);
  }
}

float dot(const Window& a, const Window& b) {
  return Eigen::Map<const Eigen::Array<float, kPatchArea, 1>>(a.data())
      .cwiseProduct(Eigen::Map<const Eigen::Array<float, kPatchArea, 1>>(b.data()))
      .sum();
}

float mean(const Window& a) {
  return Eigen::Map<const Eigen::Array<float, kPatchArea, 1>>(a.data()).mean();
}

// To zero mean and unit norm; returns the original norm, 0 for a flat window.
float normalise(Window& w) {
  Eigen::Map<Eigen::Array<float, kPatchArea, 1>> v(w.data());
  v -= v.mean();
  const float norm = std::sqrt(v.square().sum());
  if (norm < kMinContrast * std::sqrt(static_cast<float>(kPatchArea))) return 0.0F;
  v /= norm;
  return norm;
}

// Derivative of the normalised window: gradient / norm, minus its projections on the constant and on the window.
void project(Window& gradient, const Window& value, float norm) {
  Eigen::Map<Eigen::Array<float, kPatchArea, 1>> g(gradient.data());
  g /= norm;
  g -= mean(gradient);
  const float along = dot(gradient, value);
  g -= along * Eigen::Map<const Eigen::Array<float, kPatchArea, 1>>(value.data());
}

bool invert_hessian(Patch& patch) {
  Eigen::Matrix2f H;
  H(0, 0) = dot(patch.gx, patch.gx);
  H(0, 1) = H(1, 0) = dot(patch.gx, patch.gy);
  H(1, 1) = dot(patch.gy, patch.gy);
  const float det = H.determinant();
  if (!(det > 1e-7F)) return false;
  patch.H_inv = H.inverse();
  return true;
}

}  // namespace

bool make_patch(const cv::Mat& image, const Eigen::Vector2f& center, const Eigen::Matrix2f& A_source_target,
                Patch& patch) {
  const float reach = (kPatchRadius + 1) * A_source_target.cwiseAbs().rowwise().sum().maxCoeff();
  if (!inside(image, center, reach)) return false;
  std::array<float, kBorderSide * kBorderSide> grey;
  for (int r = 0; r < kBorderSide; ++r)
    for (int c = 0; c < kBorderSide; ++c) {
      const Eigen::Vector2f offset(static_cast<float>(c - kPatchRadius - 1), static_cast<float>(r - kPatchRadius - 1));
      const Eigen::Vector2f p = center + A_source_target * offset;
      grey[static_cast<size_t>(r * kBorderSide + c)] = bilinear(image, p.x(), p.y());
    }
  for (int r = 0; r < kPatchSide; ++r)
    for (int c = 0; c < kPatchSide; ++c) {
      const auto i = static_cast<size_t>(r * kPatchSide + c);
      const float* g = grey.data() + (r + 1) * kBorderSide + c + 1;
      patch.value[i] = g[0];
      patch.gx[i] = 0.5F * (g[1] - g[-1]);
      patch.gy[i] = 0.5F * (g[kBorderSide] - g[-kBorderSide]);
    }
  const float norm = normalise(patch.value);
  if (norm <= 0.0F) return false;
  project(patch.gx, patch.value, norm);
  project(patch.gy, patch.value, norm);
  return invert_hessian(patch);
}

Alignment align(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& guess, float max_shift_px) {
  Alignment result;
  Eigen::Vector2f p = guess;
  Window window;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!inside(image, p, kPatchRadius) || (p - guess).norm() > max_shift_px) return result;
    sample_axis_aligned(image, p, window);
    if (normalise(window) <= 0.0F) return result;
    result.score = dot(window, patch.value);
    Eigen::Map<Eigen::Array<float, kPatchArea, 1>>(window.data()) -=
        Eigen::Map<const Eigen::Array<float, kPatchArea, 1>>(patch.value.data());
    const Eigen::Vector2f step = patch.H_inv * Eigen::Vector2f(dot(patch.gx, window), dot(patch.gy, window));
    p -= step;
    if (step.norm() > kConvergedPx) continue;
    result.ok = inside(image, p, kPatchRadius);
    result.position = p;
    return result;
  }
  return result;
}

float correlation(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& position) {
  if (!inside(image, position, kPatchRadius)) return -1.0F;
  Window window;
  sample_axis_aligned(image, position, window);
  if (normalise(window) <= 0.0F) return -1.0F;
  return dot(window, patch.value);
}

}  // namespace rover::vo
