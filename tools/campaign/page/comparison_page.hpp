// The comparison of two campaigns as a page, and as Markdown.
#pragma once

#include <string>

#include "tools/campaign/page/comparison.hpp"

namespace rover::campaign {

struct ComparisonInfo {
  std::string name_a;
  std::string name_b;
  std::string commit_a;
  std::string commit_b;
  std::string command;
};

std::string comparison_html(const ComparisonInfo& info, const Comparison& comparison);
std::string comparison_table(const ComparisonInfo& info, const Comparison& comparison);

}  // namespace rover::campaign
