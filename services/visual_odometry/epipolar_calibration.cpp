#include "visual_odometry/epipolar_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace rover::vo {
namespace {

constexpr double kSigmaPx = 0.2;  // of a matched row
constexpr int kIterations = 3;

}  // namespace

EpipolarCalibration::EpipolarCalibration(double prior_sigma_px, double max_px)
    : max_px_(max_px), information_(Eigen::Matrix3d::Identity() / (prior_sigma_px * prior_sigma_px)) {}

void EpipolarCalibration::add(const std::vector<RowOffset>& offsets) {
  const Eigen::Matrix3d information = information_;
  const Eigen::Vector3d weighted = weighted_;
  for (int i = 0; i < kIterations; ++i) {
    information_ = information;
    weighted_ = weighted;
    for (const RowOffset& offset : offsets) {
      const Eigen::Vector3d a(1.0, offset.position.x(), offset.position.y());
      const double residual = (offset.px - a.dot(estimate_)) / kSigmaPx;
      const double weight = 1.0 / (1.0 + residual * residual) / (kSigmaPx * kSigmaPx);  // Cauchy
      information_ += weight * a * a.transpose();
      weighted_ += weight * offset.px * a;
    }
    estimate_ = information_.ldlt().solve(weighted_);
  }
}

double EpipolarCalibration::roll_px() const {
  return std::clamp(estimate_.y(), -max_px_, max_px_);
}

double EpipolarCalibration::focal_px() const {
  return std::clamp(estimate_.z(), -max_px_, max_px_);
}

}  // namespace rover::vo
