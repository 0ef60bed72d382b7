#include "path_planner/search/planners.hpp"

#include <map>

namespace rover::planning {
namespace {

std::map<std::string, MakePlanner>& planners() {
  static std::map<std::string, MakePlanner> by_name = {
      {"hybrid_a_star", [](const HybridPlannerConfig& config) -> std::shared_ptr<const Planner> {
         return std::make_shared<HybridPlanner>(config);
       }}};
  return by_name;
}

}  // namespace

void add_planner(const std::string& name, MakePlanner make) {
  ROVER_CHECK(planners().emplace(name, make).second, name);
}

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : planners()) names.push_back(name);
  return names;
}

std::shared_ptr<const Planner> make_planner(const std::string& name, const HybridPlannerConfig& config) {
  return planners().at(name)(config);
}

}  // namespace rover::planning
