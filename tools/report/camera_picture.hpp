// What the LocCam saw at an incident, with the hazard cells of that exposure.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/run_record.hpp"

namespace rover::report {

// The rectified left camera.
struct CameraView {
  double focal_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
};

struct CameraPicture {
  double t_s = 0.0;  // exposure
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> grey;       // rows from the top
  std::optional<CameraView> rectified;  // empty: as the lens saw it, and no cell has a place in it
};

// The exposure whose hazard map led to what happened at t: the newest with cells in the 3 s before, else the newest;
// NaN where there is none.
double exposure_behind(const RunRecord& run, double t_s);
// Pixel of a cell on the ground, at its height under the body's origin; empty where the camera does not see it.
std::optional<Eigen::Vector2d> pixel_of(const CameraView& view, const HazardCell& cell, double origin_height_m);

// As an SVG as wide as those of the incidents from above.
std::string draw_camera(const CameraPicture& picture, const RunRecord& run, double origin_height_m);

}  // namespace rover::report
