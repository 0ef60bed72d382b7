// The report of a run as one HTML document that needs nothing beside itself.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/report/scene.hpp"

namespace rover::report {

struct Pictures {
  std::string map;  // SVG documents
  std::vector<std::string> incidents;
  std::vector<std::string> cameras;  // one for each of them; empty where the log has no picture
  std::string elevation;             // empty where the run was not at the Full level
  std::string levels;                // likewise
  std::string states;
  std::vector<std::string> plots;
};

std::string report_html(const Scene& scene, const Pictures& pictures,
                        const std::vector<std::pair<std::string, std::string>>& configuration);

}  // namespace rover::report
