// Simulated terrain: a measured elevation model with fractal roughness below its resolution, rocks and soils.
// A pure function of configuration, elevation model and seed; safe to read from several threads.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geo/elevation_raster.hpp"
#include "rover_simulator/world/noise.hpp"
#include "rover_simulator/world/orbital_products.hpp"
#include "rover_simulator/world/rocks.hpp"
#include "rover_simulator/world/soil.hpp"
#include "rover_simulator/world/surface.hpp"

namespace rover {

struct RoughnessConfig {
  double rms_m = 0.012;         // total on firm ground; 0: smooth
  double longest_wave_m = 1.0;  // the elevation model's own resolution
  int octaves = 5;              // each with half the previous wavelength
  double hurst = 0.8;           // amplitude ~ wavelength^hurst (Mars at sub-metre scale: about 0.7-0.9)
  double sand_factor = 0.5;
  double bedrock_factor = 1.3;
};

struct WorldConfig {
  RockConfig rocks;
  RoughnessConfig roughness;
  SoilConfig soil;
  OrbitalConfig orbital;
  std::vector<KeepClear> keep_clear;
};

class World : public Surface {
 public:
  World(const WorldConfig& config, const ElevationRaster& dtm, std::uint64_t seed);

  // Heights above the elevation model's minimum; the border is extended outwards.
  double height_m(double x_m, double y_m) const override;
  Material material(double x_m, double y_m) const override;

  // Rocks whose centre is in the box.
  std::vector<Rock> rocks_in(double x0_m, double y0_m, double x1_m, double y1_m) const;
  // Orbital map for the rover: same frame and datum, with the errors of OrbitalConfig.
  ElevationRaster orbital_map(double resolution_m) const;
  // Its pixels without heights, and the displacement of what they show: a picture from orbit has the same.
  ElevationRaster orbital_frame(double resolution_m) const;
  OrbitalShift shift_in(const ElevationRaster& frame) const;

  // smooth: without roughness and rocks; ground: without rocks.
  double smooth_height_m(double x_m, double y_m) const;
  double ground_height_m(double x_m, double y_m) const;
  double width_m() const { return dtm_.width_m(); }
  double length_m() const { return dtm_.height_m(); }
  bool contains(double x_m, double y_m) const;
  const OrbitalConfig& orbital() const { return config_.orbital; }
  double datum_m() const { return datum_m_; }  // minimum of the elevation model, subtracted from it

 private:
  struct Ground {
    double height_m, slope_rad;
  };
  Ground smooth_ground(double x_m, double y_m) const;
  double roughness_m(double x_m, double y_m) const;
  std::uint64_t orbital_seed() const { return hash_cell(seed_, 77, 0); }

  WorldConfig config_;
  ElevationRaster dtm_;
  std::uint64_t seed_;
  double datum_m_ = 0.0;
  SoilZones soils_;
  RockField rocks_;
  std::vector<double> octave_rms_m_;
};

}  // namespace rover
