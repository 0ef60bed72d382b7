// Report of a run as one self-contained HTML document.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/report/scene.hpp"

namespace rover::report {

struct Pictures {
  std::string map;  // SVG documents
  std::vector<std::string> incidents;
  std::vector<std::string> cameras;  // one per incident; empty if the log has no image
  std::string elevation;             // empty if the run never used the Full level
  std::string levels;                // empty if the run never used the Full level
  std::string states;
  std::vector<std::string> plots;
};

std::string report_html(const Scene& scene, const Pictures& pictures,
                        const std::vector<std::pair<std::string, std::string>>& configuration);

}  // namespace rover::report
