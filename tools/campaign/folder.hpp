// The folder of a campaign:
//   campaign.yaml, campaign.json   the file as given; commit, command
//   jobs.jsonl, scenarios/         one line per drive; the scenario of each distinct world
//   campaign.sqlite, rows.jsonl    the rows; the text is written when a campaign ends or stops
//   runs/N, logs/                  kept run folders; output of jobs that died, and of the engine
//   work-*/                        of the running session: `open` (without it workers end), rows/, started/, ...
#pragma once

#include <string>

#include "tools/campaign/campaign_file.hpp"

namespace rover::campaign {

struct CampaignInfo {
  std::string name;
  std::string commit;
  std::string command;        // that began it
  std::string drive_program;  // rover_launcher, unless a test replaces it
};

// True if a campaign was begun here completely.
bool has_campaign(const std::string& dir);
// Makes the folder's content; refuses a folder with something else in it.
void make_campaign(const std::string& dir, const std::string& file, const CampaignFile& campaign,
                   const CampaignInfo& info);
CampaignInfo read_info(const std::string& dir);
// Throws ConfigError unless the campaign in the folder is that of the file and of the commit.
void require_same(const std::string& dir, const std::string& file, const CampaignInfo& info);

// Writes a file completely or not at all; it replaces an older one. Until then its name is that with `unfinished`.
// Throws ConfigError.
void write_file(const std::string& file, const std::string& text, const std::string& unfinished = ".new");

}  // namespace rover::campaign
