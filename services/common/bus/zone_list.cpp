#include "common/bus/zone_list.hpp"

namespace rover {
namespace {

constexpr Range kMap{-1e6, 1e6};

}  // namespace

std::vector<Zone> read_zones(const Config& config) {
  std::vector<Zone> zones;
  if (!config.has("zones")) return zones;
  for (const Config& yaml : config.list("zones")) {
    Zone zone{yaml.text("name"), yaml.one_of("kind", {"keep_out", "keep_in"}) == "keep_in", {}};
    const std::vector<double> x_m = yaml.numbers("x_m", kMap, 0);
    const std::vector<double> y_m = yaml.numbers("y_m", kMap, x_m.size());
    for (size_t i = 0; i < x_m.size(); ++i) zone.points.emplace_back(x_m[i], y_m[i]);
    zones.push_back(std::move(zone));
  }
  if (const std::string problem = zones_problem(zones); !problem.empty()) config.fail("zones", problem);
  return zones;
}

std::vector<Zone> zones_from(const path_t& message) {
  std::vector<Zone> zones;
  for (const zone_t& zone : message.zones) {
    zones.push_back({zone.name, zone.kind == zone_t::KEEP_IN, {}});
    for (size_t i = 0; i < zone.x_m.size(); ++i) zones.back().points.emplace_back(zone.x_m[i], zone.y_m[i]);
  }
  return zones;
}

void zones_to(const std::vector<Zone>& zones, path_t& message) {
  message.zones.clear();
  for (const Zone& zone : zones) {
    zone_t out{};
    out.name = zone.name;
    out.kind = zone.keep_in ? std::int8_t{zone_t::KEEP_IN} : std::int8_t{zone_t::KEEP_OUT};
    out.point_count = static_cast<std::int32_t>(zone.points.size());
    for (const Eigen::Vector2d& p : zone.points) out.x_m.push_back(p.x()), out.y_m.push_back(p.y());
    message.zones.push_back(std::move(out));
  }
  message.zone_count = static_cast<std::int32_t>(message.zones.size());
}

}  // namespace rover
