// Particles over x, y, yaw of the rover in the map's frame. Prediction by odometry, weights in log space, resampling by
// the effective number of particles (systematic; Kitagawa 1996), their number by the spread (Fox 2003, KLD sampling).
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
  double resample_share = 0.5;  // of the particles, effective: fewer and they are drawn anew
  double bin_m = 0.01;          // places this near count as one when the number is chosen
  double bin_rad = to_rad(0.1);
  double kld_error = 0.05;  // of the distribution, with 99 % probability
};

struct Particle {
  Pose2 pose;
  double log_weight = 0.0;
};

// Standard deviations of one prediction, in the rover's axes.
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
  // `motion`: the rover's new pose in its old one.
  void predict(const Pose2& motion, const MotionNoise& noise, Random& random);
  void weigh(const std::function<double(const Pose2&)>& log_likelihood);
  // Where the weights ask for it.
  void resample(Random& random);

  Pose2 mean() const;
  Eigen::Matrix3d covariance() const;  // x, y, yaw in the map's frame
  double effective() const;
  const std::vector<Particle>& particles() const { return particles_; }
  void restore(std::vector<Particle> particles) { particles_ = std::move(particles); }

 private:
  std::vector<double> weights() const;  // sum 1
  int wanted_particles() const;

  FilterConfig config_;
  std::vector<Particle> particles_;
};

// The pose `motion` further on, and back: compose(a, between(a, b)) is b.
Pose2 compose(const Pose2& pose, const Pose2& motion);
Pose2 between(const Pose2& from, const Pose2& to);

}  // namespace rover::slam
