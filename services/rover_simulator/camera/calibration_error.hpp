// The true rig: the nominal one with the error that a stereo calibration leaves.
#pragma once

#include <cstdint>

#include "common/core/camera_rig.hpp"

namespace rover {

// Focal lengths, principal points and the rotation between the cameras are off by amounts drawn from the seed, scaled
// so that the reprojection error over both images is `error_px` rms. T_body_left stays: the mount is not the
// calibration's.
StereoRig with_calibration_error(const StereoRig& nominal, double error_px, std::uint64_t seed);

// Root mean square, over both images, of the distance between where the two rigs see the same points at infinity.
double reprojection_rms_px(const StereoRig& a, const StereoRig& b);

}  // namespace rover
