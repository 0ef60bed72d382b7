// The planners by name: `planner` of config/path_planner.yaml chooses one.
#pragma once

#include <string>

#include "path_planner/search/hybrid_planner.hpp"

namespace rover::planning {

using MakePlanner = std::shared_ptr<const Planner> (*)(const HybridPlannerConfig& config);

// Before the configuration is read; the name is new.
void add_planner(const std::string& name, MakePlanner make);
std::vector<std::string> planner_names();
// Throws std::out_of_range for an unknown name.
std::shared_ptr<const Planner> make_planner(const std::string& name, const HybridPlannerConfig& config);

}  // namespace rover::planning
