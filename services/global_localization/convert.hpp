// Between the messages and the core.
#pragma once

#include <optional>
#include <rover/correction_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>

#include "global_localization/global_localization.hpp"

namespace rover::global {

ElevationView view_from(const elevation_t& message);

// None where the message is of no use: not initialised, lost, not finite.
std::optional<Prior> prior_from(const pose_t& message);

// An abstention repeats what was believed.
void correction_to(const Correction& correction, const Prior& prior, correction_t& message);

}  // namespace rover::global
