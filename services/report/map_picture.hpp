// The map of a traverse, and a close view of each of its stops and repairs.
#pragma once

#include <string>

#include "report/scene.hpp"

namespace rover::report {

// SVG documents.
std::string draw_map(const Scene& scene);
std::string draw_incident(const Scene& scene, size_t index);

}  // namespace rover::report
