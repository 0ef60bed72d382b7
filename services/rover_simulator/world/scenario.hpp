// Scenario file: world, planned traverse and run conditions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/zones.hpp"
#include "common/geo/elevation_raster.hpp"
#include "rover_simulator/world/scenario_faults.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {

struct PlannedPath {
  std::vector<double> x_m;  // map
  std::vector<double> y_m;
  std::vector<int> level;  // autonomy level of the segment that starts here; 0: Efficient, 1: Full
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
};

// Start pose given to the rover, at the path's first point, with its uncertainty.
struct PlannedStart {
  std::optional<double> yaw_rad;  // absent: along the path's first segment
  double clear_radius_m = 1.5;
  double sigma_m = 0.05;  // each axis
  double sigma_yaw_rad = to_rad(0.2);
};

struct Scenario {
  std::string name;      // file name without folder and extension
  std::string dtm_file;  // as found; empty: a synthetic plane
  ElevationRaster dtm;
  std::vector<std::string> dtm_notes;  // messages for the user: conversions, void cells
  std::uint64_t seed = 1;              // seed of the run, unless given on the command line
  WorldConfig world;                   // keep-clear circles of start and goal included
  double orbital_resolution_m = 1.0;
  std::optional<OrbitalPictureConfig> orbital_picture;  // absent: the rover has none
  double gravity_mps2 = 3.71;
  double sun_elevation_rad = to_rad(40.0);
  double sun_azimuth_rad = to_rad(135.0);    // towards the sun, counter-clockwise from east
  double calibration_error_px = 0.2;         // rms, of the true cameras against config/cameras.yaml
  double mounting_error_rad = to_rad(0.05);  // of the cameras on the body, one sigma about each axis
  // efficient; full: everywhere; auto: by path segment and by the terrain found.
  std::string level = "efficient";
  PlannedStart start;
  PlannedPath path;
  std::vector<Zone> zones;  // given to the rover with the path
  double timeout_s = 3600.0;
  std::vector<ScriptedFault> faults;

  Pose2 start_pose() const;
  double path_length_m() const;
};

// The elevation model's name is relative to the scenario's own folder. Throws ConfigError or DtmError with one line
// that names the file and the key.
Scenario load_scenario(const std::string& file);

}  // namespace rover
