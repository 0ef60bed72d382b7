// Points of the true surface in the view of a stereo camera, evenly spaced on the ground, with their line of sight.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "common/core/image.hpp"
#include "tools/truth_perception/true_surface.hpp"

namespace rover::truth {

struct View {
  StereoCamera camera;  // optics only
  Eigen::Isometry3d T_map_cam = Eigen::Isometry3d::Identity();
  double min_depth_m = 0.1;
  double max_depth_m = 10.0;
  double reach_m = std::numeric_limits<double>::infinity();  // horizontal
};

struct SurfacePoint {
  Eigen::Vector3d p_map;
  bool visible = false;  // nothing of the surface is between camera and point
};

// Of a point in the camera's axes.
bool in_both_images(const View& view, const Eigen::Vector3d& p_cam);
// Points inside both images, along rays of constant azimuth, at most TrueSurface::kSpacingM apart.
void find_points_in_view(TrueSurface& surface, const View& view, std::vector<SurfacePoint>& points);

}  // namespace rover::truth
