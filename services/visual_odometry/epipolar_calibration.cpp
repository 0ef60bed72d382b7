#include "visual_odometry/epipolar_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace rover::vo {
namespace {

constexpr double kMinSigmaPx = 0.05;   // of a matched row
constexpr double kCauchySigmas = 2.4;  // 95 % efficient if all matches are right
constexpr int kIterations = 5;

Eigen::Vector3d coefficients(const RowOffset& offset) {
  return {1.0, offset.position.x(), offset.position.y()};
}

double squared_residual(const RowOffset& offset, const Eigen::Vector3d& parameters) {
  const double residual_px = offset.px - coefficients(offset).dot(parameters);
  return residual_px * residual_px;
}

// Robust: a normal distribution has 2.2 times the median of its squares.
double variance_px2(const std::vector<RowOffset>& offsets, const Eigen::Vector3d& parameters) {
  std::vector<double> squares{kMinSigmaPx * kMinSigmaPx};
  for (const RowOffset& offset : offsets) squares.push_back(2.2 * squared_residual(offset, parameters));
  const auto middle = squares.begin() + static_cast<long>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::max(*middle, kMinSigmaPx * kMinSigmaPx);
}

Eigen::Matrix3d prior_information(const DisparityOffsetConfig& config) {
  return Eigen::Matrix3d::Identity() / (config.prior_sigma_px * config.prior_sigma_px);
}

}  // namespace

EpipolarCalibration::EpipolarCalibration(const DisparityOffsetConfig& config)
    : config_(config), information_(prior_information(config)) {}

void EpipolarCalibration::add(const std::vector<RowOffset>& offsets) {
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();  // of this keyframe alone
  Eigen::Matrix3d H;
  Eigen::Vector3d g;
  for (int i = 0; i < kIterations; ++i) {
    const double variance = variance_px2(offsets, fit);
    H.setZero();
    g.setZero();
    for (const RowOffset& offset : offsets) {
      const Eigen::Vector3d a = coefficients(offset);
      const double chi2 = squared_residual(offset, fit) / variance;
      const double weight = 1.0 / (1.0 + chi2 / (kCauchySigmas * kCauchySigmas)) / variance;
      H += weight * a * a.transpose();
      g += weight * offset.px * a;
    }
    fit = (H + prior_information(config_)).ldlt().solve(g);
  }
  information_ += config_.information_factor * H;
  weighted_ += config_.information_factor * g;
  estimate_ = information_.ldlt().solve(weighted_);
}

double EpipolarCalibration::roll_px() const {
  return std::clamp(estimate_.y(), -config_.max_px, config_.max_px);
}

double EpipolarCalibration::focal_px() const {
  return std::clamp(estimate_.z(), -config_.max_px, config_.max_px);
}

}  // namespace rover::vo
