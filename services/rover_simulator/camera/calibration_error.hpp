// True camera rig: the nominal rig with a residual stereo calibration error.
#pragma once

#include <cstdint>

#include "common/core/camera_rig.hpp"

namespace rover {

// Perturbs focal lengths, principal points and relative rotation by random amounts, scaled to a reprojection error of
// `error_px` rms over both images. T_body_left is unchanged.
StereoRig with_calibration_error(const StereoRig& nominal, double error_px, std::uint64_t seed);

// Turns the rig on its body, about the left camera, by random angles: `sigma_rad` about each axis of the body.
StereoRig with_mounting_error(const StereoRig& nominal, double sigma_rad, std::uint64_t seed);

// Rms distance, over both images, between the two rigs' projections of the same points at infinity.
double reprojection_rms_px(const StereoRig& a, const StereoRig& b);

}  // namespace rover
