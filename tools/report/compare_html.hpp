// Side-by-side comparison of two runs as one self-contained HTML document.
#pragma once

#include <string>

#include "tools/report/config_difference.hpp"
#include "tools/report/html.hpp"

namespace rover::report {

struct ComparedRun {
  std::string name;  // of the run folder
  Metrics metrics;
  Pictures pictures;
};

std::string compare_html(const ComparedRun& a, const ComparedRun& b,
                         const std::vector<ConfigDifference>& configuration);

}  // namespace rover::report
