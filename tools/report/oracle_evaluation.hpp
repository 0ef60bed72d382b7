// The shortest path that the rover could have driven on the true surface.
#pragma once

#include <optional>

#include "common/core/vehicle.hpp"
#include "tools/report/metrics.hpp"

namespace rover::report {

// From the true pose at the start of the drive to the end of the global path. Without truth or world, or unless the
// rover followed just one path: unchanged.
void evaluate_oracle(const RunRecord& run, const Vehicle& vehicle, const std::optional<TrueWorld>& world,
                     RunEvaluation& evaluation);

}  // namespace rover::report
