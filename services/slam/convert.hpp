// Conversion between messages and core types.
#pragma once

#include <rover/cloud_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <string>

#include "slam/pose_history.hpp"
#include "slam/slam.hpp"

namespace rover::slam {

// Description of the first invalid field; empty if the message is valid.
std::string fault_of(const cloud_t& message);
Cloud cloud_from(const cloud_t& message);

// True if initialised and all numbers are finite.
bool usable(const pose_t& message);
PoseSample sample_from(const pose_t& message);

void elevation_to(const OdomElevation& elevation, elevation_t& message);
void slam_pose_to(const SlamResult& result, slam_pose_t& message);

}  // namespace rover::slam
