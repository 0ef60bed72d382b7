#include "visual_odometry/config.hpp"

#include "common/bus/config.hpp"

namespace rover::vo {
namespace {

void read_corners(const Config& c, CornerConfig& corners) {
  c.read("buckets_x", corners.buckets_x, {1, 64});
  c.read("buckets_y", corners.buckets_y, {1, 64});
  c.read("per_bucket", corners.per_bucket, {1, 50});
  c.read("border_px", corners.border_px, {8, 100});
  c.read("min_distance_px", corners.min_distance_px, {1, 100});
  c.read("min_eigenvalue", corners.min_eigenvalue, {0, 1});
}

void read_stereo(const Config& c, StereoMatchConfig& stereo) {
  c.read("min_disparity_px", stereo.min_disparity_px, {0.1, 100});
  c.read("max_disparity_px", stereo.max_disparity_px, {1, 2000});
  c.read("min_score", stereo.min_score, {0, 1});
  c.read("max_row_offset_px", stereo.max_row_offset_px, {0, 10});
  c.read("max_seed_offset_px", stereo.max_seed_offset_px, {0.5, 10});
  c.read("search_without_seed", stereo.search_without_seed);
}

void read_tracker(const Config& c, TrackerConfig& tracker) {
  c.read("min_score_coarse", tracker.min_score_coarse, {0, 1});
  c.read("min_score_fine", tracker.min_score_fine, {0, 1});
  c.read("max_shift_coarse_px", tracker.max_shift_coarse_px, {0.5, 20});
  c.read("search_px", tracker.search_px, {1, 50});
  c.read("search_points", tracker.search_points, {10, 10000});
  c.read("max_shift_fine_px", tracker.max_shift_fine_px, {0.5, 20});
  c.read("max_row_offset_px", tracker.max_row_offset_px, {0, 10});
}

void read_motion(const Config& c, MotionConfig& motion) {
  c.read("ransac_iterations", motion.ransac_iterations, {1, 10000});
  c.read("coarse_gate_px", motion.coarse_gate_px, {0.1, 20});
  c.read("confidence", motion.confidence, {0.5, 1.0 - 1e-9});
  c.read("pixel_sigma_px", motion.pixel_sigma_px, {0.01, 10});
  c.read("disparity_sigma_px", motion.disparity_sigma_px, {0.01, 10});
  c.read("gate_sigma", motion.gate_sigma, {1, 10});
}

void read_offset(const Config& c, DisparityOffsetConfig& offset) {
  c.read("prior_sigma_px", offset.prior_sigma_px, {1e-3, 10});
  c.read("max_px", offset.max_px, {0, 10});
  c.read("believed_share", offset.information_factor, {0, 1});
}

void read_odometry(const Config& c, OdometryConfig& o) {
  c.read("pyramid_levels", o.pyramid_levels, {1, 8});
  c.read("min_inliers", o.min_inliers, {6, 1000});
  c.read("ok_inliers", o.ok_inliers, {6, 1000});
  c.read("ok_share", o.ok_inlier_ratio, {0, 1});
  c.read("keep_share", o.keyframe_inlier_ratio, {0, 1});
  c.read("keep_inliers", o.keyframe_inliers, {6, 1000});
  c.read("min_keyframe_points", o.min_keyframe_points, {6, 1000});
  c.read("lost_until_restart", o.lost_until_new_keyframe, {1, 100});
  c.read("max_position_sigma_m", o.max_position_sigma_m, {1e-4, 10});
  c.read_deg("gyro_tolerance_deg", o.gyro_tolerance_rad, {0.01, 180});
}

}  // namespace

NodeConfig load_config(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/visual_odometry.yaml");
  NodeConfig out;
  config.read("latency_s", out.latency_s, {0, 5});
  config.read("gyro_history_s", out.gyro_history_s, {1, 600});
  read_odometry(config.section("odometry"), out.odometry);
  read_corners(config.section("corners"), out.odometry.corners);
  read_stereo(config.section("stereo"), out.odometry.stereo);
  read_tracker(config.section("tracker"), out.odometry.tracker);
  read_motion(config.section("motion"), out.odometry.motion);
  read_offset(config.section("disparity_offset"), out.odometry.offset);
  config.finish();
  return out;
}

}  // namespace rover::vo
