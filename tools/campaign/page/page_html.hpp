// The answer of a campaign as one self-contained page, without script.
#pragma once

#include <functional>
#include <string>

#include "tools/campaign/page/grid_picture.hpp"
#include "tools/campaign/page/panels.hpp"
#include "tools/campaign/page/results.hpp"

namespace rover::campaign {

struct PageInfo {
  std::string name;
  std::string commit;
  std::string machine;
  std::string part;                               // "69 of 1800 drives"; empty: all
  std::string command;                            // that drives the campaign
  std::string page_command;                       // that makes this page
  std::string definition;                         // text of campaign.yaml
  std::function<std::string(const Row&)> repeat;  // command that repeats a drive with full recording
};

inline constexpr size_t kWorstDrives = 3;  // of each cause

// What both pages share: the style of the panels, and a row of pictures.
std::string campaign_style();
std::string picture_row(const std::vector<GridPicture>& pictures);
// Number, "95 % (92–97)".
std::string success_text(int reached, int of);
// "rock area 10 %, uphill, seed 7", without the axes in `common`.
std::string drive_title(const Row& row, const Cell& common);
// Values that say how bad a drive was, as "progress 0.12, 14 of 80 m driven".
std::string drive_facts(const Row& row);

std::string page_html(const PageInfo& info, const Panels& panels, const Drives& drives);

}  // namespace rover::campaign
