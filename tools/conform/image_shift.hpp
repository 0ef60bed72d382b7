// Direction of the disparity between the left and the right image.
#pragma once

#include <optional>

#include "common/core/image.hpp"

namespace rover::conform {

// Median disparity [px] of a grid of patches, searched within +-reach (positive: left in the right image). Empty: too
// few matches.
std::optional<double> shift_to_left_px(const GrayImage& left, const GrayImage& right, int reach);

}  // namespace rover::conform
