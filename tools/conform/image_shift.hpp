// Which way the ground in the left picture lies in the right one.
#pragma once

#include <optional>

#include "common/core/image.hpp"

namespace rover::conform {

// How far to the left patches of the left picture are found in the right one [px], median over a grid of patches within
// +- reach; empty where too few are found.
std::optional<double> shift_to_left_px(const GrayImage& left, const GrayImage& right, int reach);

}  // namespace rover::conform
