// Rectification and dense disparity of a calibrated stereo pair.
#pragma once

#include <optional>

#include "common/stereo/matcher.hpp"
#include "common/stereo/rectifier.hpp"

namespace rover::stereo {

struct StereoConfig {
  bool ground_reference = true;  // search relative to the disparity of the ground plane
  MatcherConfig matcher;
};

struct StereoResult {
  GrayImage left;  // rectified
  GrayImage right;
  Disparity disparity;  // kInvalid without a match
};

class Stereo {
 public:
  // origin_height_m: height of the body origin above flat ground.
  Stereo(const StereoConfig& config, const StereoRig& rig, double origin_height_m);

  const StereoCamera& camera() const { return rectifier_.camera(); }
  // Empty if an image does not have the rig's size.
  std::optional<StereoResult> step(const GrayImage& left, const GrayImage& right);

 private:
  Rectifier rectifier_;
  Matcher matcher_;
};

}  // namespace rover::stereo
