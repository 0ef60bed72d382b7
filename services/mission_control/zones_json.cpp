#include "mission_control/zones_json.hpp"

namespace rover::mission {

using nlohmann::json;

json zones_json(const std::vector<Zone>& zones) {
  json out = json::array();
  for (const Zone& zone : zones) {
    json points = json::array();
    for (const Eigen::Vector2d& p : zone.points) points.push_back({p.x(), p.y()});
    out.push_back({{"name", zone.name}, {"kind", zone.keep_in ? "keep_in" : "keep_out"}, {"points", points}});
  }
  return out;
}

std::vector<Zone> zones_from(const json& list) {
  std::vector<Zone> zones;
  for (const json& item : list.get_ref<const json::array_t&>()) {
    const auto kind = item.at("kind").get<std::string>();
    if (kind != "keep_out" && kind != "keep_in")
      throw json::other_error::create(501, "kind: must be keep_out or keep_in", &item);
    Zone zone{item.at("name").get<std::string>(), kind == "keep_in", {}};
    for (const json& point : item.at("points").get_ref<const json::array_t&>())
      zone.points.emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
    zones.push_back(std::move(zone));
  }
  return zones;
}

}  // namespace rover::mission
