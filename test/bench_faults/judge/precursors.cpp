#include "test/bench_faults/judge/precursors.hpp"

#include <map>

namespace rover::bench_faults {
namespace {

// Rows that monitor the streams of a service.
const std::map<std::string, std::set<std::string>> kStreams = {{"stereo", {"hazards_age", "loccam_out"}},
                                                               {"hazard_detector", {"hazards_age", "loccam_out"}},
                                                               {"localization", {"pose_age"}},
                                                               {"path_planner", {"planner_age"}},
                                                               {"trajectory_control", {"control_age", "command_age"}}};

// Of the same motor or service, if the row has one.
const std::map<std::string, std::set<std::string>> kLower = {{"pose_sigma", {"pose_sigma_high"}},
                                                             {"vo_age", {"vo_age_high"}},
                                                             {"drive_heat", {"drive_heat_high"}},
                                                             {"roll_steep", {"roll_high"}},
                                                             {"roll", {"roll_high", "roll_steep"}},
                                                             {"pitch", {"pitch_high"}},
                                                             {"slip", {"slip_high"}},
                                                             {"hazards_blind", {"stereo_coverage_low"}},
                                                             {"stereo_coverage", {"stereo_coverage_low"}},
                                                             {"out_of_corridor", {"corridor_predicted"}},
                                                             {"message_loss", {"message_loss_high"}},
                                                             {"heartbeat", {"heartbeat_late"}},
                                                             {"restart_failed", {"service_fault"}},
                                                             {"full_restart_failed", {"full_service_fault"}},
                                                             {"full_missing", {"full_idle_heartbeat"}},
                                                             {"sweep_timeout", {"terrain_distance"}},
                                                             {"fault_stops", {"pose_status"}}};

}  // namespace

std::set<std::string> precursors(const std::string& row) {
  const size_t dot = row.find('.');
  const std::string line = row.substr(0, dot);
  const std::string suffix = dot == std::string::npos ? "" : row.substr(dot);
  std::set<std::string> out;
  if (const auto lower = kLower.find(line); lower != kLower.end())
    for (const std::string& one : lower->second) out.insert(one + suffix);
  // A hanging or repeatedly restarted service publishes nothing either.
  const bool silent = line == "heartbeat" || line == "heartbeat_late" || line == "starts";
  const auto streams = silent ? kStreams.find(suffix.substr(1)) : kStreams.end();
  if (streams != kStreams.end()) out.insert(streams->second.begin(), streams->second.end());
  // After a restart the controller has no path until the planner repeats it, and localization has used no image.
  if (row == "starts.trajectory_control") out.insert("path_mismatch");
  if (row == "starts.localization") out.insert({"vo_age_high", "vo_age"});
  return out;
}

}  // namespace rover::bench_faults
