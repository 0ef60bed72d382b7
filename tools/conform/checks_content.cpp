#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/core/frames.hpp"
#include "tools/conform/checks.hpp"
#include "tools/conform/image_shift.hpp"

namespace rover::conform {
namespace {

constexpr double kIntervalTolerance = 0.1;
constexpr double kMinGravity = 1.0;  // Moon 1.6, Mars 3.7, Earth 9.8
constexpr double kMaxGravity = 12.0;
constexpr double kMaxTilt = 0.466;       // tan 25 deg
constexpr double kMaxRestRate = 0.0175;  // 1 deg/s: rejects gyros in wrong units
constexpr double kMaxRestWheel = 0.02;
constexpr double kMinGrey = 10.0;
constexpr double kMaxGrey = 245.0;
constexpr double kMinContrast = 4.0;
constexpr double kMaxUnpaired = 0.05;

const char kNothing[] = "no messages received";

Line interval_line(const Received& received) {
  const std::string requirement = "dt_s is the time since the previous message; all values finite; status OK";
  if (received.imu.size() < 2) return skipped("IMU interval", kNothing, requirement);
  int bad = 0;
  for (size_t i = 1; i < received.imu.size(); ++i) {
    const ReceivedImu& now = received.imu[i];
    const double step_s = to_seconds(now.stamp.utime - received.imu[i - 1].stamp.utime);
    const bool one_step = now.stamp.seq == received.imu[i - 1].stamp.seq + 1 && step_s > 0.0;
    const bool wrong = one_step && !(std::abs(now.dt_s - step_s) <= kIntervalTolerance * step_s);
    const bool finite =
        now.delta_angle_rad.allFinite() && now.delta_velocity_mps.allFinite() && std::isfinite(now.fog_delta_yaw_rad);
    bad += wrong || !finite || !now.ok ? 1 : 0;
  }
  return line("IMU interval", bad == 0, fmt::format("{} of {} messages differ", bad, received.imu.size()), requirement);
}

// Sums over the time covered by the timestamps: a wrong dt_s has its own check.
struct ImuMeans {
  Eigen::Vector3d force_mps2;
  Eigen::Vector3d rate_radps;
  double fog_radps = 0.0;
};

ImuMeans imu_means(const Received& received) {
  const double covered_s = to_seconds(received.imu.back().stamp.utime - received.imu.front().stamp.utime);
  ImuMeans sums{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
  for (size_t i = 1; i < received.imu.size(); ++i) {
    const ReceivedImu& imu = received.imu[i];
    if (!imu.delta_angle_rad.allFinite() || !imu.delta_velocity_mps.allFinite()) continue;
    sums.force_mps2 += imu.delta_velocity_mps / covered_s;
    sums.rate_radps += imu.delta_angle_rad / covered_s;
    if (std::isfinite(imu.fog_delta_yaw_rad)) sums.fog_radps += imu.fog_delta_yaw_rad / covered_s;
  }
  return sums;
}

std::vector<Line> rest_lines(const Received& received) {
  const std::string upward = fmt::format("{} to {} m/s2 upward (+z), within 25 deg of it", kMinGravity, kMaxGravity);
  const std::string still = "below 1 deg/s at rest";
  if (received.imu.size() < 2) return {skipped("gravity", kNothing, upward), skipped("gyros", kNothing, still)};
  const ImuMeans means = imu_means(received);
  const Eigen::Vector3d& f = means.force_mps2;
  const bool up = f.z() >= kMinGravity && f.z() <= kMaxGravity && f.head<2>().norm() <= kMaxTilt * f.z();
  const double rate = std::max(means.rate_radps.norm(), std::abs(means.fog_radps));
  return {line("gravity", up, fmt::format("({:.2f}, {:.2f}, {:.2f}) m/s2", f.x(), f.y(), f.z()), upward),
          line("gyros", rate <= kMaxRestRate, fmt::format("{:.3f} deg/s", to_deg(rate)), still)};
}

Line wheels_line(const Received& received) {
  const std::string requirement = "finite, no FAULT, at rest without a command";
  if (received.wheels.empty()) return skipped("wheels at rest", kNothing, requirement);
  double fastest = 0.0;
  int bad = 0;
  for (const ReceivedWheels& wheels : received.wheels) {
    bad += !wheels.finite || wheels.fault ? 1 : 0;
    for (double rate : wheels.rate_radps) fastest = std::fmax(fastest, std::abs(rate));
  }
  const double turned = std::abs(received.wheels.back().angle_rad[0] - received.wheels.front().angle_rad[0]);
  return line("wheels at rest", bad == 0 && fastest <= kMaxRestWheel && turned <= kMaxRestWheel,
              fmt::format("fastest {:.3f} rad/s, turned {:.3f} rad, {} bad messages", fastest, turned, bad),
              requirement);
}

Line size_line(const Received& received, const StereoRig& loccam) {
  const std::string requirement = fmt::format("{} x {} MONO8, as in cameras.yaml", loccam.width, loccam.height);
  std::set<std::string> sizes;
  bool right = true;
  for (const auto* side : {&received.left, &received.right})
    for (const ReceivedImage& image : *side) {
      sizes.insert(fmt::format("{} x {} in {} bytes", image.width, image.height, image.bytes));
      right = right && image.width == loccam.width && image.height == loccam.height && image.mono8 &&
              image.bytes == image.width * image.height;
    }
  if (sizes.empty()) return skipped("image size", kNothing, requirement);
  return line("image size", right, *sizes.begin() + (sizes.size() > 1 ? " and others" : ""), requirement);
}

Line pairs_line(const Received& received) {
  const std::string requirement = "both images of a pair have the same utime";
  if (received.left.empty() || received.right.empty()) return skipped("pairs", kNothing, requirement);
  std::set<Utime> left;
  int alone = 0;
  for (const ReceivedImage& image : received.left) left.insert(image.stamp.utime);
  for (const ReceivedImage& image : received.right) alone += left.contains(image.stamp.utime) ? 0 : 1;
  // The first and the last pair may be incomplete.
  const int most = 1 + static_cast<int>(kMaxUnpaired * static_cast<double>(received.right.size()));
  return line("pairs", alone <= most,
              fmt::format("{} of {} right images have no left image", alone, received.right.size()), requirement);
}

const GrayImage* first_kept(const std::vector<ReceivedImage>& images) {
  for (const ReceivedImage& image : images)
    if (!image.image.data.empty()) return &image.image;
  return nullptr;
}

Line contrast_line(const Received& received) {
  const std::string requirement =
      fmt::format("mean grey {:.0f} to {:.0f}, spread {:.0f} and more", kMinGrey, kMaxGrey, kMinContrast);
  std::string measured;
  bool good = true;
  for (const auto* side : {&received.left, &received.right}) {
    const GrayImage* image = first_kept(*side);
    if (image == nullptr) continue;
    double sum = 0.0;
    double sum2 = 0.0;
    for (const std::uint8_t grey : image->data) {
      sum += grey;
      sum2 += static_cast<double>(grey) * grey;
    }
    const auto n = static_cast<double>(image->data.size());
    const double mean = sum / n;
    const double spread = std::sqrt(std::max(0.0, sum2 / n - mean * mean));
    good = good && mean >= kMinGrey && mean <= kMaxGrey && spread >= kMinContrast;
    measured += fmt::format("{}mean {:.0f}, spread {:.0f}", measured.empty() ? "" : "; ", mean, spread);
  }
  if (measured.empty()) return skipped("exposure", kNothing, requirement);
  return line("exposure", good, measured, requirement);
}

// Points at 1 m and beyond must appear further left in the right image (positive disparity).
Line sides_line(const Received& received, const StereoRig& loccam) {
  const std::string requirement = "the ground is farther left in the right image";
  for (const ReceivedImage& left : received.left)
    for (const ReceivedImage& right : received.right) {
      if (left.stamp.utime != right.stamp.utime || left.image.data.empty() || right.image.data.empty()) continue;
      const double nearest_m = 0.5;
      const double expected_px = loccam.left.fx_px * loccam.T_left_right.translation().norm() / nearest_m;
      const int reach = std::min(static_cast<int>(expected_px), left.width / 4);
      const auto shift = shift_to_left_px(left.image, right.image, reach);
      if (!shift) return skipped("left and right", "no ground was matched between the images", requirement);
      return line("left and right", *shift > 0.0, fmt::format("by {:.0f} px", *shift), requirement);
    }
  return skipped("left and right", "no pair", requirement);
}

}  // namespace

std::vector<Line> check_content(const Received& received, const StereoRig& loccam) {
  std::vector<Line> lines{interval_line(received)};
  for (Line& rest : rest_lines(received)) lines.push_back(std::move(rest));
  lines.push_back(wheels_line(received));
  lines.push_back(size_line(received, loccam));
  lines.push_back(pairs_line(received));
  lines.push_back(contrast_line(received));
  lines.push_back(sides_line(received, loccam));
  return lines;
}

}  // namespace rover::conform
