// A scenario file: the world, the traverse planned in it, and the conditions of the run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_raster.hpp"
#include "rover_simulator/world/scenario_faults.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover {

struct PlannedPath {
  std::vector<double> x_m;  // map
  std::vector<double> y_m;
  std::vector<int> level;  // of the segment that starts here; 0: Efficient, 1: Full
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
};

// The start lies on the path's first point. What the ground believes of it, and how sure it is.
struct PlannedStart {
  std::optional<double> yaw_rad;  // absent: along the path's first segment
  double clear_radius_m = 1.5;
  double sigma_m = 0.05;  // each axis
  double sigma_yaw_rad = to_rad(0.2);
};

struct Scenario {
  std::string name;      // of the file, without folder and ending
  std::string dtm_file;  // as found; empty: a synthetic plane
  ElevationRaster dtm;
  std::vector<std::string> dtm_notes;  // for the user: what was converted, what was taken for void
  std::uint64_t seed = 1;              // of everything random in the run, unless the command gives another
  WorldConfig world;                   // keep-clear circles of start and goal included
  double orbital_resolution_m = 1.0;
  double gravity_mps2 = 3.71;
  double sun_elevation_rad = to_rad(40.0);
  double sun_azimuth_rad = to_rad(135.0);  // towards the sun, counter-clockwise from east
  double calibration_error_px = 0.2;       // rms, of the true cameras against config/cameras.yaml
  std::string level =
      "efficient";  // full: everywhere; auto: as the path's segments say, and as the rover finds the ground
  PlannedStart start;
  PlannedPath path;
  double timeout_s = 3600.0;
  std::vector<ScriptedFault> faults;

  Pose2 start_pose() const;
  double path_length_m() const;
};

// The elevation model's name is relative to the scenario's own folder. Throws ConfigError or DtmError with one line
// that names the file and the key.
Scenario load_scenario(const std::string& file);

}  // namespace rover
