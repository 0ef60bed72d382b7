// How well a cloud lies on the map at a given place and heading of the rover, and what the ground's shape tells of
// them.
//
// The residual of a patch is its height over the map's. What the attitude and the height of odometry leave open, a
// small plane, is fitted for each pose anew (with a prior) and taken out. The kernel is that of Geman and McClure: what
// is occluded or has moved costs the same wherever the rover is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/match_surface.hpp"
#include "slam/patches.hpp"

namespace rover::slam {

struct MatchConfig {
  int max_patches = 2500;        // of the cloud, evenly taken
  double max_range_m = 5.0;      // further off noise of depth, cut at the sensor's range, lifts the ground
  int min_patches = 150;         // on the map; fewer tell nothing
  double model_sigma_m = 0.006;  // what neither cloud nor map say about their own errors
  double blur_m = 0.015;         // horizontal, of the lattice: times the slope it is an error of height
  double kernel_sigma = 3.0;
  double temper = 2.0;           // of the likelihood: patches share errors, and their variances are on the safe side
  double height_sigma_m = 0.02;  // of the plane that is taken out
  double tilt_sigma_rad = 0.002;
  double probe_m = 0.05;         // over which the information is measured
  double blind_sigma_m = 0.012;  // a direction in which the ground tells less than this tells nothing
  double lever_m = 3.0;          // makes metres of yaw, to compare it with x and y
};

struct MatchFit {
  double log_likelihood = 0.0;
  double fitting_share = 0.0;  // of the points on the map: within the kernel
  Eigen::Vector3f plane =
      Eigen::Vector3f::Zero();  // height [m] at the rover, rise along its x and y [1]: cloud over map
};

// x, y, yaw of the rover in the map's frame.
struct MatchInformation {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();    // [1/m^2, 1/m, 1/rad^2]
  Eigen::Matrix3d informed = Eigen::Matrix3d::Zero();  // takes an offset to its part that the ground tells of
  int directions = 0;                                  // that it tells of, 0 .. 3
  double weakest = 0.0;  // 1 / standard deviation [1/m] of the weakest of them, yaw at the lever; 0: none
};

class ScanMatcher {
 public:
  explicit ScanMatcher(const MatchConfig& config) : config_(config) {}

  // Patches in the rover's own axes. `reference`: where the rover about is; weights are those of that place. The
  // surface must outlive the next calls.
  void prepare(const std::vector<Patch>& patches, const MatchSurface& surface, const Pose2& reference);
  int matched() const { return static_cast<int>(points_.size()); }
  bool enough() const { return matched() >= config_.min_patches; }

  MatchFit fit(const Pose2& pose, int iterations = 1) const;
  MatchInformation information(const Pose2& pose) const;

 private:
  struct Point {
    float x, y, z;
    float weight;   // 1 / variance
    float neutral;  // what it costs off the map: as much as at the reference, so that the map's border neither draws
                    // nor repels
  };
  // From the rover's axes to the surface's cells.
  struct ToCells {
    float cos, sin, x, y;
    ToCells(const MatchSurface& surface, const Pose2& pose);
    float u(const Point& p) const { return x + cos * p.x - sin * p.y; }
    float v(const Point& p) const { return y + sin * p.x + cos * p.y; }
  };
  Eigen::Matrix3d curvature(const Pose2& pose) const;
  void residuals_at(const Pose2& pose) const;
  Eigen::Vector3f fitted_plane(const Eigen::Vector3f& from) const;
  MatchFit judged(const Eigen::Vector3f& plane) const;
  float off(size_t i, const Eigen::Vector3f& plane) const {
    return residual_[i] - plane.x() - plane.y() * points_[i].x - plane.z() * points_[i].y;
  }

  MatchConfig config_;
  const MatchSurface* surface_ = nullptr;
  std::vector<Point> points_;
  Eigen::Vector3f start_plane_ = Eigen::Vector3f::Zero();
  mutable std::vector<float> residual_;  // of each point at the pose looked at; NaN: off the map
};

}  // namespace rover::slam
