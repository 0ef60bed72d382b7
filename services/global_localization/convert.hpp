// Conversion between messages and core types.
#pragma once

#include <optional>
#include <rover/correction_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>

#include "global_localization/global_localization.hpp"

namespace rover::global {

ElevationView view_from(const elevation_t& message);

// Empty if the pose is not initialised, lost or not finite.
std::optional<Prior> prior_from(const pose_t& message);

// A rejected correction repeats the prior.
void correction_to(const Correction& correction, const Prior& prior, correction_t& message);

}  // namespace rover::global
