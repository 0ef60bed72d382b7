// Map of a traverse, and a top view of each stop and repair.
#pragma once

#include <array>
#include <string>

#include "tools/report/scene.hpp"

namespace rover::report {

// Groups of class "layer-ID" in the map's SVG.
enum class MapLayer { kRelief, kSlope, kRocks, kHazards, kPaths, kOracle, kTracks, kEvents };
struct MapLayerInfo {
  const char* id;
  const char* title;
  bool on;  // initially
};
inline constexpr std::array<MapLayerInfo, 8> kMapLayers = {{{"relief", "hillshade", true},
                                                            {"slope", "slope", false},
                                                            {"rocks", "rocks", true},
                                                            {"hazards", "detected hazards", true},
                                                            {"paths", "paths", true},
                                                            {"oracle", "shortest drivable path", true},
                                                            {"tracks", "tracks", true},
                                                            {"events", "events", true}}};

// SVG documents.
std::string draw_map(const Scene& scene);
std::string draw_incident(const Scene& scene, size_t index);

}  // namespace rover::report
