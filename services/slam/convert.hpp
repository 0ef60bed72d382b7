// Between the messages and the core.
#pragma once

#include <rover/cloud_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <string>

#include "slam/pose_history.hpp"
#include "slam/slam.hpp"

namespace rover::slam {

// What is wrong with the message; empty: nothing.
std::string fault_of(const cloud_t& message);
Cloud cloud_from(const cloud_t& message);

// Usable: a status that tells of a position, and every number finite.
bool usable(const pose_t& message);
PoseSample sample_from(const pose_t& message);

void elevation_to(const OdomElevation& elevation, elevation_t& message);
void slam_pose_to(const SlamResult& result, slam_pose_t& message);

}  // namespace rover::slam
