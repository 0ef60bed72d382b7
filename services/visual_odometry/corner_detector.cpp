#include "visual_odometry/corner_detector.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace rover::vo {
namespace {

struct Candidate {
  float strength;
  int x;
  int y;
};

bool is_stronger(const Candidate& a, const Candidate& b) {
  if (a.strength != b.strength) return a.strength > b.strength;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

bool is_local_maximum(const cv::Mat& strength, int x, int y) {
  const float s = strength.at<float>(y, x);
  for (int dy = -1; dy <= 1; ++dy) {
    const float* row = strength.ptr<float>(y + dy);
    for (int dx = -1; dx <= 1; ++dx) {
      const bool before = dy < 0 || (dy == 0 && dx < 0);
      if (row[x + dx] > s || (before && row[x + dx] == s)) return false;
    }
  }
  return true;
}

std::vector<Candidate> candidates_in(const cv::Mat& strength, const cv::Rect& bucket, double min_strength) {
  std::vector<Candidate> found;
  for (int y = bucket.y; y < bucket.y + bucket.height; ++y) {
    const float* row = strength.ptr<float>(y);
    for (int x = bucket.x; x < bucket.x + bucket.width; ++x)
      if (row[x] > min_strength && is_local_maximum(strength, x, y)) found.push_back({row[x], x, y});
  }
  std::sort(found.begin(), found.end(), is_stronger);
  return found;
}

bool is_far_from_all(const std::vector<Eigen::Vector2f>& corners, const Eigen::Vector2f& p, float distance) {
  return std::none_of(corners.begin(), corners.end(),
                      [&](const Eigen::Vector2f& q) { return (p - q).squaredNorm() < distance * distance; });
}

}  // namespace

std::vector<Eigen::Vector2f> detect_corners(const cv::Mat& image, const CornerConfig& config) {
  cv::Mat strength;
  cv::cornerMinEigenVal(image, strength, 5);
  const int width = image.cols - 2 * config.border_px;
  const int height = image.rows - 2 * config.border_px;
  std::vector<Eigen::Vector2f> corners;
  for (int by = 0; by < config.buckets_y; ++by)
    for (int bx = 0; bx < config.buckets_x; ++bx) {
      const int x0 = config.border_px + width * bx / config.buckets_x;
      const int x1 = config.border_px + width * (bx + 1) / config.buckets_x;
      const int y0 = config.border_px + height * by / config.buckets_y;
      const int y1 = config.border_px + height * (by + 1) / config.buckets_y;
      int taken = 0;
      for (const Candidate& c : candidates_in(strength, {x0, y0, x1 - x0, y1 - y0}, config.min_eigenvalue)) {
        const Eigen::Vector2f p(static_cast<float>(c.x), static_cast<float>(c.y));
        if (!is_far_from_all(corners, p, static_cast<float>(config.min_distance_px))) continue;
        corners.push_back(p);
        if (++taken == config.per_bucket) break;
      }
    }
  return corners;
}

}  // namespace rover::vo
