#include "visual_odometry/config.hpp"

namespace rover::vo {
namespace {

void add_odometry(Parameters p, OdometryConfig& c) {
  p.add("pyramid_levels", c.pyramid_levels, {1, 8}, "each halves the image");
  p.add("min_inliers", c.min_inliers, {6, 1000}, "fewer: LOST");
  p.add("ok_inliers", c.ok_inliers, {6, 1000}, "fewer: DEGRADED");
  p.add("ok_inlier_ratio", c.ok_inlier_ratio, {0, 1}, "inliers / tracked points; less: DEGRADED");
  p.add("keyframe_inlier_ratio", c.keyframe_inlier_ratio, {0, 1}, "inliers / keyframe points; less: new keyframe");
  p.add("keyframe_inliers", c.keyframe_inliers, {6, 1000}, "fewer: new keyframe");
  p.add("min_keyframe_points", c.min_keyframe_points, {6, 1000}, "a pair with fewer cannot become keyframe");
  p.add("lost_until_new_keyframe", c.lost_until_new_keyframe, {1, 100}, "consecutive lost pairs before a new keyframe");
  p.add("max_position_sigma_m", c.max_position_sigma_m, {1e-4, 10}, "more: LOST");
  p.add_deg("gyro_tolerance_deg", c.gyro_tolerance_rad, {0.01, 180},
            "rotation difference of gyro and images; more: DEGRADED");
}

void add_corners(Parameters p, CornerConfig& c) {
  p.add("buckets_x", c.buckets_x, {1, 64}, "spread the corners over the image");
  p.add("buckets_y", c.buckets_y, {1, 64}, "the same, rows");
  p.add("per_bucket", c.per_bucket, {1, 50}, "strongest corners of a bucket");
  p.add("border_px", c.border_px, {8, 100}, "minimum distance from the image border");
  p.add("min_distance_px", c.min_distance_px, {1, 100}, "between two corners");
  p.add("min_eigenvalue", c.min_eigenvalue, {0, 1},
        "of the structure tensor over 5 x 5 px, grey values in [0, 1]: about twice that of noise of one grey value");
}

void add_stereo(Parameters p, StereoMatchConfig& c) {
  p.add("min_disparity_px", c.min_disparity_px, {0.1, 100}, "farther points are ignored");
  p.add("max_disparity_px", c.max_disparity_px, {1, 2000}, "LocCam: ground 0.31 m away");
  p.add("min_score", c.min_score, {0, 1}, "correlation of the two patches");
  p.add("max_row_offset_px", c.max_row_offset_px, {0, 10}, "residual of rectification");
  p.add("max_seed_offset_px", c.max_seed_offset_px, {0.5, 10}, "between the dense disparity and the refined one");
  p.add("search_without_seed", c.search_without_seed, "corners without a dense disparity are searched along their row");
}

void add_tracker(Parameters p, TrackerConfig& c) {
  p.add("min_score_coarse", c.min_score_coarse, {0, 1}, "correlation, over the image pyramid");
  p.add("min_score_fine", c.min_score_fine, {0, 1}, "correlation, at full resolution");
  p.add("max_shift_coarse_px", c.max_shift_coarse_px, {0.5, 20}, "from the predicted motion, on each pyramid level");
  p.add("search_px", c.search_px, {1, 50},
        "half side of the search window in the smallest image, without a motion prediction");
  p.add("search_points", c.search_points, {10, 10000}, "points searched there");
  p.add("max_shift_fine_px", c.max_shift_fine_px, {0.5, 20}, "from the prediction by the coarse motion");
  p.add("max_row_offset_px", c.max_row_offset_px, {0, 10}, "vertical, between left and right");
}

void add_motion(Parameters p, MotionConfig& c) {
  p.add("ransac_iterations", c.ransac_iterations, {1, 10000}, "HDPR");
  p.add("coarse_gate_px", c.coarse_gate_px, {0.1, 20}, "inlier gate of RANSAC on coarse tracks");
  p.add("confidence", c.confidence, {0.5, 1.0 - 1e-9}, "RANSAC stops early at this confidence");
  p.add("pixel_sigma_px", c.pixel_sigma_px, {0.01, 10}, "of a tracked pixel");
  p.add("disparity_sigma_px", c.disparity_sigma_px, {0.01, 10}, "of the keyframe's disparity");
  p.add("gate_sigma", c.gate_sigma, {1, 10}, "inlier gate of the refinement");
}

void add_disparity_offset(Parameters p, DisparityOffsetConfig& c) {
  p.add("prior_sigma_px", c.prior_sigma_px, {1e-3, 10}, "of the camera calibration");
  p.add("max_px", c.max_px, {0, 10}, "bound of each estimate");
  p.add("information_factor", c.information_factor, {0, 1},
        "of each measurement: residuals of one keyframe, and of one place, are correlated");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  OdometryConfig& c = config.odometry;
  Parameters p(
      config_dir + "/visual_odometry.yaml",
      "Visual odometry. Values without a source were tuned on rendered drives and on the recorded pairs of the "
      "tests.",
      list);
  p.add("latency_s", config.latency_s, {0, 5}, "modelled processing time, disparity to motion");
  p.add("gyro_history_s", config.gyro_history_s, {1, 600},
        "longest gap between two pairs that the gyro can predict over");
  add_odometry(p.section("odometry", "states and keyframes"), c);
  add_corners(p.section("corners", "Shi-Tomasi corners"), c.corners);
  add_stereo(p.section("stereo", "sub-pixel match of a corner"), c.stereo);
  add_tracker(p.section("tracker", "the keyframe's points in a later pair"), c.tracker);
  add_motion(p.section("motion", "RANSAC and Gauss-Newton"), c.motion);
  add_disparity_offset(p.section("disparity_offset", "online self-calibration of the stereo pair"), c.disparity_offset);
  p.finish();
  return config;
}

}  // namespace rover::vo
