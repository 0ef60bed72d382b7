// Absolute localization: the ground that the rover has seen, found again in the orbital map (Azkarate et al. 2020:
// correlation of the gradients of both elevation maps). Planar: x, y and yaw of T_map_odom.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "common/core/frames.hpp"
#include "global_localization/height_grid.hpp"
#include "global_localization/local_mosaic.hpp"
#include "global_localization/place_search.hpp"
#include "global_localization/plane_field.hpp"
#include "global_localization/refinement.hpp"

namespace rover::global {

struct SearchConfig {
  double min_reach_m = 12.0;  // the window is at least this large: covariances are optimistic after long drives
  double max_reach_m = 15.0;
  double min_reach_rad = to_rad(12.0);
  double max_reach_rad = to_rad(12.0);
  double sigmas = 3.0;  // of the pose, that the window covers between these bounds
  double yaw_step_rad = to_rad(2.0);
  double min_overlap = 0.8;  // of the template, that the orbital map must know
  double apart_m = 4.0;      // of peaks that count as different places
  int peaks = 8;             // that are refined
};

struct AcceptanceConfig {
  double min_area_m2 = 100.0;  // seen
  // What the ground lets expect of a match, by its relief and the map's noise ("featured").
  double max_expected_sigma_cells = 0.2;
  double max_expected_sigma_rad = to_rad(0.25);
  double min_score = 0.5;           // correlation of the gradients
  double max_residual_m = 0.25;     // of the heights
  double max_residual_ratio = 0.8;  // to the residual at the next best place
  double max_sigma_m = 0.4;         // of the match, in the weakest direction
  double max_sigma_rad = to_rad(1.0);
  double max_body_sigma_m = 1.1;  // of the body, which may stand far from the ground that was matched
  double gate_chi2 = 16.3;  // against the pose, whose sigma counts as at least a third of the window's least reach
};

struct GlobalConfig {
  double mosaic_side_m = 120.0;
  double max_height_sigma_m = 0.3;
  double map_noise_m = 0.1;  // of the orbital map's heights, and over how many cells it hangs together
  double map_noise_cells = 1.0;
  double map_blur_cells =
      0.7;  // of the orbital map as it comes, in its cells: what the rover has seen is blurred as much
  PlaneConfig filter{1.5, 0.5};  // takes out the noise of orbital maps, which neighbouring cells share
  BendConfig bend;
  SearchConfig search;
  RefinementConfig refinement;
  AcceptanceConfig acceptance;
  double map_sigma_m = 0.2;  // how far the orbital map itself may show the matched ground moved, and turned about its
                             // centre; part of the covariance
  double map_sigma_rad = to_rad(0.3);
};

// What is believed of the pose.
struct Prior {
  Pose2 T_map_odom;
  Eigen::Vector2d p_odom_body = Eigen::Vector2d::Zero();
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();  // x, y [m] and yaw [rad] of the body, map axes
};

struct Correction {
  bool accepted = false;
  std::string_view reason = {};  // of an abstention
  Pose2 T_map_odom{kNaN, kNaN, kNaN};
  Eigen::Matrix3d cov = Eigen::Matrix3d::Constant(kNaN);  // as Prior::cov
  double score = 0.0;                                     // correlation of the gradients, here
  double second_score = 0.0;                              // and at the next best place
  double residual_m = kNaN;                               // of the heights, here
  double second_residual_m = kNaN;                        // and at the next best place
  double area_m2 = 0.0;                                   // seen
  double expected_sigma_m = kNaN;  // of the body, by relief and the map's noise, in the weakest direction
  double expected_sigma_rad = kNaN;
  double sigma_m = kNaN;  // of the match, in the weakest direction
};

class GlobalLocalization {
 public:
  // `orbital`: in map. `local_cell_m`: of the elevation maps to come.
  GlobalLocalization(const GlobalConfig& config, HeightGrid orbital, double local_cell_m);

  void take(const ElevationView& view, const Eigen::Vector2d& p_odom_body);
  // What was seen: odom is no longer what it was.
  void forget() { mosaic_.clear(); }
  Correction correct(const Prior& prior) const;
  // Whether the ground of this try tells enough, whatever came of it.
  bool featured(const Correction& correction) const;

 private:
  void match(const Prior& prior, const TerrainTemplate& terrain, Correction& out) const;
  double noise_density() const;
  OrbitalPart part_about(const Eigen::Vector2d& center_map, double reach_m) const;

  GlobalConfig config_;
  HeightGrid orbital_;
  LocalMosaic mosaic_;
};

}  // namespace rover::global
