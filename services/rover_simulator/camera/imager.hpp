// Image sensor model: blur, vignetting, exposure, shot and read noise, 8-bit quantisation.
#pragma once

#include <cstdint>
#include <vector>

#include "common/core/image.hpp"

namespace rover {

struct ImagerConfig {
  double full_well_e = 15000.0;  // electrons at the value 255 (estimate for a small CCD)
  double read_noise_e = 25.0;
  double vignetting = 0.12;       // loss of light in the corners
  double blur_weight = 0.11;      // of each neighbour in the three-tap kernel: sigma 0.47 px
  double exposure_target = 95.0;  // target mean grey value of the exposure control
  double exposure_gain = 0.7;     // fraction of the logarithmic error corrected per image
  double exposure_min_s = 0.0002;
  double exposure_max_s = 0.1;
  double radiance_per_second = 120.0;  // grey value / 255 = radiance x exposure x this
};

// Radiance image, normalised to 1 for a white surface at normal sun incidence.
struct RadianceImage {
  int width = 0;
  int height = 0;
  std::vector<float> data;

  RadianceImage() = default;
  RadianceImage(int w, int h) : width(w), height(h), data(static_cast<size_t>(w) * h) {}
};

class Imager {
 public:
  Imager(const ImagerConfig& config, int width, int height);

  // Row `v` of the image. `noise_key` is a hash of seed, frame and camera.
  void expose_row(const RadianceImage& radiance, double exposure_s, std::uint64_t noise_key, int v,
                  GrayImage& image) const;

 private:
  ImagerConfig config_;
  std::vector<float> vignetting_;
};

// Exposure time for the next image from the mean of the last one.
double next_exposure_s(const ImagerConfig& config, double exposure_s, double mean_grey);
// For the first image: the time at which this scene would have the target mean.
double metered_exposure_s(const ImagerConfig& config, const RadianceImage& radiance);
double mean_grey(const GrayImage& image);

}  // namespace rover
