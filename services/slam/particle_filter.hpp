// Particle filter over x, y, yaw of the rover in the map's frame: odometry prediction, log weights, systematic
// resampling by effective sample size (Kitagawa 1996), KLD-adaptive particle count (Fox 2003).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/core/frames.hpp"
#include "slam/random.hpp"

namespace rover::slam {

struct FilterConfig {
  int min_particles = 100;
  int max_particles = 400;
  double resample_ratio = 0.5;  // resample if the effective sample size is below this share
  double bin_m = 0.01;          // histogram bins of KLD sampling
  double bin_rad = to_rad(0.1);
  double kld_error = 0.05;  // KLD bound, with 99 % probability
};

struct Particle {
  Pose2 pose;
  double log_weight = 0.0;
};

// Standard deviations of one prediction step, in the rover's axes.
struct MotionNoise {
  double along_m = 0.0;
  double across_m = 0.0;
  double yaw_rad = 0.0;
};

class ParticleFilter {
 public:
  explicit ParticleFilter(const FilterConfig& config) : config_(config) {}

  void reset(const Pose2& pose);
  bool running() const { return !particles_.empty(); }
  // `motion`: the new pose relative to the previous one.
  void predict(const Pose2& motion, const MotionNoise& noise, Random& random);
  void update(const std::function<double(const Pose2&)>& log_likelihood);
  // Only if the effective sample size is too small.
  void resample(Random& random);

  Pose2 mean() const;
  Eigen::Matrix3d covariance() const;  // x, y, yaw in the map's frame
  double effective_particles() const;
  const std::vector<Particle>& particles() const { return particles_; }
  void restore(std::vector<Particle> particles) { particles_ = std::move(particles); }

 private:
  std::vector<double> weights() const;  // sum 1
  int kld_particle_count() const;

  FilterConfig config_;
  std::vector<Particle> particles_;
};

// SE(2) composition and its inverse: compose(a, between(a, b)) == b.
Pose2 compose(const Pose2& pose, const Pose2& motion);
Pose2 between(const Pose2& from, const Pose2& to);

}  // namespace rover::slam
