#include "tools/campaign/folder.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "common/bus/text_file.hpp"
#include "common/bus/yaml_file.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "tools/campaign/axes.hpp"
#include "tools/campaign/job.hpp"
#include "tools/campaign/variant.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr size_t kMaxFile = 1 << 20;
const std::string kBegun = "campaign.json.begun";  // becomes campaign.json when the folder is complete
// What a start that was killed may have left beside it.
const std::set<std::string> kOwnNames = {"campaign.yaml", "campaign.yaml.new", "jobs.jsonl", "scenarios"};

void require_empty(const std::string& dir) {
  const bool begun = fs::exists(dir + "/" + kBegun);
  for (const auto& entry : fs::directory_iterator(dir)) {
    const std::string name = entry.path().filename();
    if (name != "lock" && !name.starts_with(kBegun) && !(begun && kOwnNames.contains(name)))
      throw ConfigError(dir + ": is not empty and has no campaign; choose another folder with --out");
  }
}

Job job_of(const Drive& drive) {
  Job job{drive.cell, drive.seed, "scenarios/" + variant_name(drive.cell) + ".yaml", "", "", {}};
  for (const auto& [axis, value] : drive.cell) {
    if (axis == "level") job.level = value;
    if (axis == "perception") job.perception = value;
    if (find_axis(axis) == nullptr && is_parameter(axis)) job.set.push_back(axis + "=" + value);
  }
  return job;
}

void write_variant(const std::string& file, const Drive& drive) {
  write_yaml(file, make_variant(load_yaml(drive.scenario), drive.scenario, drive.cell));
  load_scenario(file);  // throws if the base and the cell do not fit together
}

}  // namespace

bool has_campaign(const std::string& dir) {
  return fs::exists(dir + "/campaign.json");
}

void make_campaign(const std::string& dir, const std::string& file, const CampaignFile& campaign,
                   const CampaignInfo& info) try {
  require_empty(dir);
  const Json json = {{"name", info.name},
                     {"commit", info.commit},
                     {"command", info.command},
                     {"drive_program", info.drive_program},
                     {"jobs", campaign.drives.size()}};
  write_file(dir + "/" + kBegun, json.dump(2) + "\n");
  fs::create_directories(dir + "/scenarios");
  std::vector<Job> jobs;
  std::set<std::string> variants;
  for (const Drive& drive : campaign.drives) {
    jobs.push_back(job_of(drive));
    if (variants.insert(jobs.back().scenario).second) write_variant(dir + "/" + jobs.back().scenario, drive);
  }
  write_jobs(dir, jobs);
  write_file(dir + "/campaign.yaml", read_text(file, kMaxFile));
  fs::rename(dir + "/" + kBegun, dir + "/campaign.json");
} catch (const fs::filesystem_error& error) {
  throw ConfigError(dir + ": cannot be written: " + error.code().message());
}

CampaignInfo read_info(const std::string& dir) try {
  const Json json = Json::parse(read_text(dir + "/campaign.json", kMaxFile));
  return {json.at("name"), json.at("commit"), json.at("command"), json.at("drive_program")};
} catch (const Json::exception& error) {
  throw ConfigError(dir + "/campaign.json: not of a campaign: " + error.what());
}

void require_same(const std::string& dir, const std::string& file, const CampaignInfo& info) {
  const CampaignInfo present = read_info(dir);
  if (read_text(file, kMaxFile) != read_text(dir + "/campaign.yaml", kMaxFile))
    throw ConfigError(file + ": differs from " + dir + "/campaign.yaml; begin a new campaign with --out");
  if (present.commit != info.commit)
    throw ConfigError(dir + ": was begun by commit " + present.commit + ", this is " + info.commit +
                      "; begin a new campaign with --out");
  if (present.drive_program != info.drive_program)
    throw ConfigError(dir + ": was begun with the drive program " + present.drive_program);
}

void write_file(const std::string& file, const std::string& text, const std::string& unfinished) {
  const std::string new_file = file + unfinished;
  const int out = open(new_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  bool written = out >= 0;
  for (size_t at = 0; written && at < text.size();) {
    const ssize_t count = write(out, text.data() + at, text.size() - at);
    written = count > 0;
    at += static_cast<size_t>(std::max<ssize_t>(count, 0));
  }
  // Without fsync a power failure may leave the name with half of the text.
  written = written && fsync(out) == 0;
  int error = errno;
  if (out >= 0) close(out);
  if (written && rename(new_file.c_str(), file.c_str()) == 0) return;
  if (written) error = errno;
  unlink(new_file.c_str());
  throw ConfigError(file + ": cannot be written: " + std::strerror(error));
}

}  // namespace rover::campaign
