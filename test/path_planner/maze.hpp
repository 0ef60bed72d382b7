// Mazes of rock walls, as a property of the planner: it reaches the goal, or says that there is no path if there is
// none.
#pragma once

#include <string>

#include "test/path_planner/rock_drive.hpp"

namespace rover::planning::testing_support {

struct Maze {
  std::vector<Rock> walls;
  std::vector<Point2> path;  // straight through the walls, from the first room to the last
  bool open = true;          // a way leads to the goal
};

// Square rooms of 3.2 m between rows of stones; some walls are left out at random, and in every fifth maze the goal's
// room is closed.
Maze random_maze(int rooms_aside, std::uint64_t seed);

// The largest number of times that a room is entered.
int max_visits(const std::vector<Pose2>& track);

// What is wrong with the drive; empty: nothing.
std::string maze_problem(const Maze& maze, const DriveResult& result);

}  // namespace rover::planning::testing_support
