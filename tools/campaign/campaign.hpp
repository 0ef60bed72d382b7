// ./rover campaign FILE: makes or resumes a campaign, and runs it to its end.
#pragma once

#include <string>

#include "tools/campaign/worker.hpp"

namespace rover::campaign {

struct CampaignArguments {
  std::string file;
  std::string source_dir;
  std::string bin_dir;
  std::string out;  // folder; empty: logs/campaigns/NAME
  std::string engine = "parallel";
  std::string sshloginfile;
  std::string drive_program;  // empty: rover_launcher
  std::string command;        // as typed
  int jobs = 0;               // 0: the engine's default
  bool resume = false;
  Keep keep = Keep::kFailures;
};

// Exit status: 0 if every drive has its row, 1 if it was stopped. Throws ConfigError.
int run_campaign(const CampaignArguments& arguments);

// True if a drive of the file needs the services of the Full level.
bool needs_full_level(const CampaignArguments& arguments);

}  // namespace rover::campaign
