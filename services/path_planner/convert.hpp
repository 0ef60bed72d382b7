// Messages to core types and back.
#pragma once

#include <rover/hazards_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/traversability_t.hpp>
#include <string>

#include "path_planner/path_planner.hpp"

namespace rover::planning {

PoseSample pose_from(const pose_t& message, double origin_height_m);
HazardGrid hazards_from(const hazards_t& message);
TraversabilityGrid traversability_from(const traversability_t& message);
// Why the message cannot be taken; empty where it can.
std::string global_path_from(const path_t& message, GlobalPath& path);
void path_to(const LocalPath& path, path_t& message);
void status_to(const PlannerStatus& status, planner_status_t& message);

}  // namespace rover::planning
