// Rectification and dense disparity of a calibrated pair, once for all users.
#pragma once

#include <optional>

#include "common/stereo/matcher.hpp"
#include "common/stereo/rectifier.hpp"

namespace rover::stereo {

struct StereoConfig {
  bool ground_reference = true;  // search about the disparity of the ground plane
  MatcherConfig matcher;
};

struct StereoResult {
  GrayImage left;  // rectified
  GrayImage right;
  Disparity disparity;  // all kInvalid where nothing was found
};

class Stereo {
 public:
  // ground_below_m: of the body origin on flat ground.
  Stereo(const StereoConfig& config, const StereoRig& rig, double ground_below_m);

  const StereoCamera& camera() const { return rectifier_.camera(); }
  // Empty where an image has not the rig's size.
  std::optional<StereoResult> step(const GrayImage& left, const GrayImage& right);

 private:
  Rectifier rectifier_;
  Matcher matcher_;
};

}  // namespace rover::stereo
