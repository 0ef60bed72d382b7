#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/core/frames.hpp"
#include "tools/conform/duties.hpp"
#include "tools/conform/image_shift.hpp"

namespace rover::conform {
namespace {

constexpr double kIntervalTolerance = 0.1;
constexpr double kLeastGravity = 1.0;  // Moon 1.6, Mars 3.7, Earth 9.8
constexpr double kMostGravity = 12.0;
constexpr double kMostTilt = 0.466;       // tan 25 deg
constexpr double kMostRestRate = 0.0175;  // 1 deg/s: no gyro in the wrong unit passes as one that drifts
constexpr double kMostRestWheel = 0.02;
constexpr double kLeastGrey = 10.0;
constexpr double kMostGrey = 245.0;
constexpr double kLeastContrast = 4.0;
constexpr double kMostUnpaired = 0.05;

const char kNothing[] = "nothing was heard";

Line interval_line(const Heard& heard) {
  const std::string demand = "dt_s is the time since the message before; all numbers finite; status OK";
  if (heard.imu.size() < 2) return skipped("IMU interval", kNothing, demand);
  int bad = 0;
  for (size_t i = 1; i < heard.imu.size(); ++i) {
    const ImuHeard& now = heard.imu[i];
    const double step_s = to_seconds(now.stamp.utime - heard.imu[i - 1].stamp.utime);
    const bool one_step = now.stamp.seq == heard.imu[i - 1].stamp.seq + 1 && step_s > 0.0;
    const bool wrong = one_step && !(std::abs(now.dt_s - step_s) <= kIntervalTolerance * step_s);
    const bool finite =
        now.delta_angle_rad.allFinite() && now.delta_velocity_mps.allFinite() && std::isfinite(now.fog_delta_yaw_rad);
    bad += wrong || !finite || !now.ok ? 1 : 0;
  }
  return line("IMU interval", bad == 0, fmt::format("{} of {} messages are not so", bad, heard.imu.size()), demand);
}

// Sums over the time that they cover by the stamps: a wrong dt_s is a matter of its own.
struct ImuMeans {
  Eigen::Vector3d force_mps2;
  Eigen::Vector3d rate_radps;
  double fog_radps = 0.0;
};

ImuMeans imu_means(const Heard& heard) {
  const double covered_s = to_seconds(heard.imu.back().stamp.utime - heard.imu.front().stamp.utime);
  ImuMeans sums{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
  for (size_t i = 1; i < heard.imu.size(); ++i) {
    const ImuHeard& imu = heard.imu[i];
    if (!imu.delta_angle_rad.allFinite() || !imu.delta_velocity_mps.allFinite()) continue;
    sums.force_mps2 += imu.delta_velocity_mps / covered_s;
    sums.rate_radps += imu.delta_angle_rad / covered_s;
    if (std::isfinite(imu.fog_delta_yaw_rad)) sums.fog_radps += imu.fog_delta_yaw_rad / covered_s;
  }
  return sums;
}

std::vector<Line> rest_lines(const Heard& heard) {
  const std::string upward = fmt::format("{} to {} m/s2 upward (+z), within 25 deg of it", kLeastGravity, kMostGravity);
  const std::string still = "below 1 deg/s at rest";
  if (heard.imu.size() < 2) return {skipped("gravity", kNothing, upward), skipped("gyros", kNothing, still)};
  const ImuMeans means = imu_means(heard);
  const Eigen::Vector3d& f = means.force_mps2;
  const bool up = f.z() >= kLeastGravity && f.z() <= kMostGravity && f.head<2>().norm() <= kMostTilt * f.z();
  const double rate = std::max(means.rate_radps.norm(), std::abs(means.fog_radps));
  return {line("gravity", up, fmt::format("({:.2f}, {:.2f}, {:.2f}) m/s2", f.x(), f.y(), f.z()), upward),
          line("gyros", rate <= kMostRestRate, fmt::format("{:.3f} deg/s", to_deg(rate)), still)};
}

Line wheels_line(const Heard& heard) {
  const std::string demand = "finite, no FAULT, at rest without a command";
  if (heard.wheels.empty()) return skipped("wheels at rest", kNothing, demand);
  double fastest = 0.0;
  int bad = 0;
  for (const WheelsHeard& wheels : heard.wheels) {
    bad += !wheels.finite || wheels.fault ? 1 : 0;
    for (double rate : wheels.rate_radps) fastest = std::fmax(fastest, std::abs(rate));
  }
  const double turned = std::abs(heard.wheels.back().angle_rad[0] - heard.wheels.front().angle_rad[0]);
  return line("wheels at rest", bad == 0 && fastest <= kMostRestWheel && turned <= kMostRestWheel,
              fmt::format("fastest {:.3f} rad/s, turned {:.3f} rad, {} bad messages", fastest, turned, bad), demand);
}

Line size_line(const Heard& heard, const StereoRig& loccam) {
  const std::string demand = fmt::format("{} x {} MONO8, as in cameras.yaml", loccam.width, loccam.height);
  std::set<std::string> sizes;
  bool right = true;
  for (const auto* side : {&heard.left, &heard.right})
    for (const ImageHeard& image : *side) {
      sizes.insert(fmt::format("{} x {} in {} bytes", image.width, image.height, image.bytes));
      right = right && image.width == loccam.width && image.height == loccam.height && image.mono8 &&
              image.bytes == image.width * image.height;
    }
  if (sizes.empty()) return skipped("image size", kNothing, demand);
  return line("image size", right, *sizes.begin() + (sizes.size() > 1 ? " and others" : ""), demand);
}

Line pairs_line(const Heard& heard) {
  const std::string demand = "both pictures of a pair have the same utime";
  if (heard.left.empty() || heard.right.empty()) return skipped("pairs", kNothing, demand);
  std::set<Utime> left;
  int alone = 0;
  for (const ImageHeard& image : heard.left) left.insert(image.stamp.utime);
  for (const ImageHeard& image : heard.right) alone += left.contains(image.stamp.utime) ? 0 : 1;
  // The first and the last pair may be cut in half by the beginning and the end of listening.
  const int most = 1 + static_cast<int>(kMostUnpaired * static_cast<double>(heard.right.size()));
  return line("pairs", alone <= most,
              fmt::format("{} of {} right pictures have no left one", alone, heard.right.size()), demand);
}

const GrayImage* first_kept(const std::vector<ImageHeard>& images) {
  for (const ImageHeard& image : images)
    if (!image.image.data.empty()) return &image.image;
  return nullptr;
}

Line contrast_line(const Heard& heard) {
  const std::string demand =
      fmt::format("mean grey {:.0f} to {:.0f}, spread {:.0f} and more", kLeastGrey, kMostGrey, kLeastContrast);
  std::string measured;
  bool good = true;
  for (const auto* side : {&heard.left, &heard.right}) {
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
    good = good && mean >= kLeastGrey && mean <= kMostGrey && spread >= kLeastContrast;
    measured += fmt::format("{}mean {:.0f}, spread {:.0f}", measured.empty() ? "" : "; ", mean, spread);
  }
  if (measured.empty()) return skipped("exposure", kNothing, demand);
  return line("exposure", good, measured, demand);
}

// The ground in the middle of the view, one metre and more away, lies further left in the right picture.
Line sides_line(const Heard& heard, const StereoRig& loccam) {
  const std::string demand = "the ground lies further left in the right picture";
  for (const ImageHeard& left : heard.left)
    for (const ImageHeard& right : heard.right) {
      if (left.stamp.utime != right.stamp.utime || left.image.data.empty() || right.image.data.empty()) continue;
      const double nearest_m = 0.5;
      const double expected_px = loccam.left.fx_px * loccam.T_left_right.translation().norm() / nearest_m;
      const int reach = std::min(static_cast<int>(expected_px), left.width / 4);
      const auto shift = shift_to_left_px(left.image, right.image, reach);
      if (!shift) return skipped("left and right", "no ground was found in both pictures", demand);
      return line("left and right", *shift > 0.0, fmt::format("by {:.0f} px", *shift), demand);
    }
  return skipped("left and right", "no pair", demand);
}

}  // namespace

std::vector<Line> judge_content(const Heard& heard, const StereoRig& loccam) {
  std::vector<Line> lines{interval_line(heard)};
  for (Line& rest : rest_lines(heard)) lines.push_back(std::move(rest));
  lines.push_back(wheels_line(heard));
  lines.push_back(size_line(heard, loccam));
  lines.push_back(pairs_line(heard));
  lines.push_back(contrast_line(heard));
  lines.push_back(sides_line(heard, loccam));
  return lines;
}

}  // namespace rover::conform
