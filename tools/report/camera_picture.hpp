// LocCam image at an incident, with the hazard cells of that exposure.
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
  std::optional<CameraView> rectified;  // empty: a raw image, in which cells cannot be drawn
};

// Exposure of the hazard map that led to an event at t: the newest with cells within 3 s, else the newest; NaN if none.
double exposure_behind(const RunRecord& run, double t_s);
// Pixel of a ground cell at the ground height below the body origin; empty if outside the image.
std::optional<Eigen::Vector2d> pixel_of(const CameraView& view, const HazardCell& cell, double origin_height_m);

// SVG document with the width of the top views of incidents.
std::string draw_camera(const CameraPicture& picture, const RunRecord& run, double origin_height_m);

}  // namespace rover::report
