#include "slam/particle_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace rover::slam {
namespace {

constexpr double kQuantile99 = 2.326;

}  // namespace

Pose2 compose(const Pose2& pose, const Pose2& motion) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  return {pose.x_m + c * motion.x_m - s * motion.y_m, pose.y_m + s * motion.x_m + c * motion.y_m,
          wrap_angle(pose.yaw_rad + motion.yaw_rad)};
}

Pose2 between(const Pose2& from, const Pose2& to) {
  const double c = std::cos(from.yaw_rad), s = std::sin(from.yaw_rad);
  const double dx = to.x_m - from.x_m, dy = to.y_m - from.y_m;
  return {c * dx + s * dy, c * dy - s * dx, wrap_angle(to.yaw_rad - from.yaw_rad)};
}

void ParticleFilter::reset(const Pose2& pose) {
  particles_.assign(static_cast<size_t>(config_.min_particles), Particle{pose, 0.0});
}

void ParticleFilter::predict(const Pose2& motion, const MotionNoise& noise, Random& random) {
  // Antithetic pairs: the noise does not move the mean.
  double along = 0.0, across = 0.0, yaw_noise = 0.0;
  for (size_t i = 0; i < particles_.size(); ++i) {
    Particle& particle = particles_[i];
    const bool opposite = i % 2 == 1;
    along = opposite ? -along : noise.along_m * random.gauss();
    across = opposite ? -across : noise.across_m * random.gauss();
    yaw_noise = opposite ? -yaw_noise : noise.yaw_rad * random.gauss();
    // Half of the yaw noise acts before the translation, so that a yaw error also displaces the rover sideways.
    const Pose2 noisy = compose({0.0, 0.0, 0.5 * yaw_noise}, {motion.x_m + along, motion.y_m + across, motion.yaw_rad});
    particle.pose = compose(particle.pose, {noisy.x_m, noisy.y_m, noisy.yaw_rad + 0.5 * yaw_noise});
  }
}

void ParticleFilter::update(const std::function<double(const Pose2&)>& log_likelihood) {
  for (Particle& particle : particles_) particle.log_weight += log_likelihood(particle.pose);
}

std::vector<double> ParticleFilter::weights() const {
  double best = -kInfinity, sum = 0.0;
  for (const Particle& particle : particles_) best = std::max(best, particle.log_weight);
  std::vector<double> w;
  w.reserve(particles_.size());
  for (const Particle& particle : particles_) sum += w.emplace_back(std::exp(particle.log_weight - best));
  for (double& weight : w) weight /= sum;
  return w;
}

double ParticleFilter::effective_particles() const {
  double squares = 0.0;
  for (const double w : weights()) squares += w * w;
  return 1.0 / squares;
}

Pose2 ParticleFilter::mean() const {
  const std::vector<double> w = weights();
  const double yaw = particles_.front().pose.yaw_rad;
  Pose2 mean;
  double turned = 0.0;
  for (size_t i = 0; i < w.size(); ++i) {
    mean.x_m += w[i] * particles_[i].pose.x_m;
    mean.y_m += w[i] * particles_[i].pose.y_m;
    turned += w[i] * wrap_angle(particles_[i].pose.yaw_rad - yaw);
  }
  mean.yaw_rad = wrap_angle(yaw + turned);
  return mean;
}

Eigen::Matrix3d ParticleFilter::covariance() const {
  const std::vector<double> w = weights();
  const Pose2 center = mean();
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < w.size(); ++i) {
    const Pose2& p = particles_[i].pose;
    const Eigen::Vector3d off(p.x_m - center.x_m, p.y_m - center.y_m, wrap_angle(p.yaw_rad - center.yaw_rad));
    cov += w[i] * off * off.transpose();
  }
  return cov;
}

// KLD sampling (Fox 2003), over the bins that hold significant weight.
int ParticleFilter::kld_particle_count() const {
  const std::vector<double> w = weights();
  std::set<std::array<int, 3>> bins;
  for (size_t i = 0; i < w.size(); ++i) {
    if (w[i] * static_cast<double>(w.size()) < 0.1) continue;
    const Pose2& p = particles_[i].pose;
    bins.insert({static_cast<int>(std::floor(p.x_m / config_.bin_m)),
                 static_cast<int>(std::floor(p.y_m / config_.bin_m)),
                 static_cast<int>(std::floor(p.yaw_rad / config_.bin_rad))});
  }
  const auto k = static_cast<double>(bins.size()) - 1.0;
  if (k < 1.0) return config_.min_particles;
  const double share = 2.0 / (9.0 * k), root = 1.0 - share + std::sqrt(share) * kQuantile99;
  const double count = k / (2.0 * config_.kld_error) * root * root * root;
  return static_cast<int>(std::clamp(count, 1.0 * config_.min_particles, 1.0 * config_.max_particles));
}

void ParticleFilter::resample(Random& random) {
  if (effective_particles() >= config_.resample_ratio * static_cast<double>(particles_.size())) return;
  const std::vector<double> w = weights();
  const int count = kld_particle_count();
  std::vector<Particle> resampled;
  resampled.reserve(static_cast<size_t>(count));
  const double step = 1.0 / count, first = step * random.unit();
  double cumulative = w[0];
  for (size_t i = 0; static_cast<int>(resampled.size()) < count;) {
    if (cumulative >= first + static_cast<double>(resampled.size()) * step || i + 1 == w.size())
      resampled.push_back({particles_[i].pose, 0.0});
    else
      cumulative += w[++i];
  }
  particles_ = std::move(resampled);
}

}  // namespace rover::slam
