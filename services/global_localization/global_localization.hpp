// Absolute localization by matching the local elevation map against the orbital one (Azkarate et al. 2020: correlation
// of the two maps' gradients), and where relief does not locate the rover, the local picture of the ground against the
// orbital one. Estimates x, y and yaw of T_map_odom.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "common/core/frames.hpp"
#include "global_localization/correlation_search.hpp"
#include "global_localization/local_mosaic.hpp"
#include "global_localization/orbital_map.hpp"
#include "global_localization/plane_field.hpp"
#include "global_localization/refinement.hpp"

namespace rover::global {

struct SearchConfig {
  double min_half_width_m = 12.0;  // lower bound of the half width: covariances are optimistic after long drives
  double max_half_width_m = 500.0;
  double min_half_width_rad = to_rad(12.0);
  double max_half_width_rad = to_rad(12.0);
  double sigmas = 3.0;  // half width in pose standard deviations, clamped to these bounds
  double yaw_step_rad = to_rad(2.0);
  double min_overlap = 0.8;  // fraction of the template with orbital data
  double min_peak_distance_m = 4.0;
  int max_peaks = 8;    // number of peaks to refine
  int max_cells = 600;  // side of the window; a wider one is searched coarse to fine
};

struct AcceptanceConfig {
  double min_area_m2 = 100.0;  // observed
  // Expected accuracy of a match, from the relief and the map's noise; terrain within it is "featured". Within
  // max_expected_sigma_cells along one axis only, as beside a ridge, a match gives a fix along that axis.
  double max_expected_sigma_cells = 0.2;
  double max_expected_sigma_rad = to_rad(0.25);
  double min_score = 0.5;           // correlation of the gradients
  double max_residual_m = 0.25;     // rms height difference
  double max_residual_ratio = 0.8;  // best residual over second-best residual
  double max_sigma_m = 0.4;         // of the match, along the largest principal axis
  double max_sigma_rad = to_rad(1.0);
  double max_body_sigma_m = 1.1;  // of the body, including the lever arm from the matched terrain
  double gate_chi2 = 16.3;        // normalised innovation squared; prior sigma is at least min_half_width / sigmas
};

struct PictureConfig {
  double mosaic_side_m = 60.0;  // of the local picture
  PlaneConfig filter{.sigma_cells = 1.0, .min_support = 0.5};
  double yaw_step_rad = to_rad(1.0);
  int max_samples = 600;    // compared in the search
  double min_sigmas = 5.0;  // from the second-best place's correlation to the best one's, in units of chance
};

struct GlobalConfig {
  double mosaic_side_m = 120.0;
  double max_height_sigma_m = 0.3;
  double map_noise_m = 0.1;      // orbital height noise, rms
  double map_noise_cells = 1.0;  // correlation length of that noise
  double map_blur_cells = 0.7;   // Gaussian blur already in the orbital map; the local map gets the same
  PlaneConfig filter;            // suppresses orbital noise that is correlated between neighbouring cells
  DriftConfig height_drift;
  SearchConfig search;
  RefinementConfig refinement;
  AcceptanceConfig acceptance;
  PictureConfig picture;
  // Distortion of the orbital map and picture, along each axis, and its correlation length; part of the covariance.
  double map_sigma_m = 0.3;
  double map_sigma_length_m = 20.0;
};

// Current pose estimate.
struct Prior {
  Pose2 T_map_odom;
  Eigen::Vector2d p_odom_body = Eigen::Vector2d::Zero();
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();  // x, y [m] and yaw [rad] of the body, map axes
  double since_fix_m = kInfinity;                 // distance driven since the last fix
};

// Whether the prior is less certain than the smallest search window.
bool is_lost(const SearchConfig& config, const Prior& prior);

inline constexpr std::string_view kMapTooSmall = "local map too small";

struct Correction {
  Layer layer = Layer::kHeight;
  bool accepted = false;
  std::string_view reason = {};          // why the match was rejected; empty if accepted
  std::string_view picture_reason = {};  // the same of the picture, if it was tried after relief
  int axes = 0;                          // along which the relief locates the rover: 2 (and yaw), 1 or 0
  Pose2 T_map_odom{kNaN, kNaN, kNaN};    // with one axis: the prior's across it, and its yaw
  Eigen::Matrix3d cov = Eigen::Matrix3d::Constant(kNaN);  // as Prior::cov
  double score = 0.0;                                     // correlation of the best match
  double second_score = 0.0;                              // and of the second best
  double residual = kNaN;                                 // of the best match (Fit::residual)
  double second_residual = kNaN;                          // and of the second best
  int similar_places = 0;                                 // too similar to decide between, the best included
  double area_m2 = 0.0;                                   // observed
  double expected_sigma_m = kNaN;  // of the body, from relief and map noise, along the largest principal axis
  double expected_sigma_rad = kNaN;
  double sigma_m = kNaN;  // of the match, along the largest principal axis
};

class GlobalLocalization {
 public:
  // `orbital`, `picture`: of heights and of brightness, in the map frame. `local_cell_m`: cell size of the elevation
  // maps passed to add_elevation.
  GlobalLocalization(const GlobalConfig& config, OrbitalMap orbital, double local_cell_m,
                     std::optional<OrbitalMap> picture = std::nullopt);

  void add_elevation(const ElevationView& view, const Eigen::Vector2d& p_odom_body);
  // Discards the local map, for example after odom has jumped.
  void clear_local_map();
  // By relief, else by the picture. Throws what reading the orbital map throws.
  Correction correct(const Prior& prior) const;
  Correction correct_by_relief(const Prior& prior) const;
  Correction correct_by_picture(const Prior& prior) const;
  // Whether the terrain of this attempt has enough relief, accepted or not.
  bool featured(const Correction& correction) const;

 private:
  // What the orbiter and the rover saw of one quantity.
  struct Source {
    Layer layer;
    OrbitalMap orbital;
    LocalMosaic mosaic;
    PlaneConfig filter;
  };
  struct Candidates {
    std::vector<Match> matches;            // by increasing residual
    OrbitalSection section{PlaneField{}};  // of the orbital map, about the best
  };

  // `axis_odom`: of the largest information, if out.axes is 1.
  void match(const Source& source, const Prior& prior, const TerrainTemplate& terrain, const SearchWindow& window,
             const Eigen::Vector2d& axis_odom, Correction& out) const;
  double noise_density() const;
  TerrainTemplate template_of(const Source& source, int n) const;
  OrbitalSection orbital_section(const Source& source, const Eigen::Vector2d& center_map, double half_width_m,
                                 int n) const;
  Candidates search(const Source& source, const SearchWindow& window, const TerrainTemplate& terrain) const;
  Candidates search_coarse_to_fine(const Source& source, const SearchWindow& window, const TerrainTemplate& terrain,
                                   int n) const;

  GlobalConfig config_;
  Source relief_;
  std::optional<Source> picture_;
};

}  // namespace rover::global
