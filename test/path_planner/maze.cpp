#include "test/path_planner/maze.hpp"

#include <map>
#include <numeric>

namespace rover::planning::testing_support {
namespace {

constexpr double kRoomM = 3.2;
constexpr double kStoneM = 0.2;  // radius; the height makes it a hazard for wheels and body
constexpr double kStoneStepM = 0.3;
constexpr double kExtraDoors = 0.2;  // of the walls that the tree of rooms leaves
constexpr int kMaxVisits = 3;

struct Wall {
  int room_a, room_b;  // rows of rooms; room_b is to the right of room_a or above it
};

void lay_stones(Point2 from, Point2 to, std::vector<Rock>& stones) {
  const int count = static_cast<int>(std::ceil(distance(from, to) / kStoneStepM));
  for (int i = 0; i <= count; ++i) {
    const double u = static_cast<double>(i) / count;
    stones.push_back({{from.x_m + u * (to.x_m - from.x_m), from.y_m + u * (to.y_m - from.y_m)}, kStoneM, 0.3});
  }
}

// Middle of room (0, 0) is the origin.
void lay_wall(const Wall& wall, int aside, std::vector<Rock>& stones) {
  const double x_m = (wall.room_a % aside) * kRoomM, y_m = (wall.room_a / aside) * kRoomM, half_m = 0.5 * kRoomM;
  if (wall.room_b == wall.room_a + 1)
    lay_stones({x_m + half_m, y_m - half_m}, {x_m + half_m, y_m + half_m}, stones);
  else
    lay_stones({x_m - half_m, y_m + half_m}, {x_m + half_m, y_m + half_m}, stones);
}

std::vector<Wall> shuffled_walls(int aside, std::mt19937_64& random) {
  std::vector<Wall> walls;
  for (int room = 0; room < aside * aside; ++room) {
    if (room % aside + 1 < aside) walls.push_back({room, room + 1});
    if (room / aside + 1 < aside) walls.push_back({room, room + aside});
  }
  for (size_t i = walls.size(); i > 1; --i) std::swap(walls[i - 1], walls[random() % i]);
  return walls;
}

}  // namespace

// Kruskal's tree over the rooms, and a few doors more, so that there are loops.
Maze random_maze(int rooms_aside, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const int goal = rooms_aside * rooms_aside - 1;
  Maze maze;
  maze.open = seed % 5 != 0;
  std::vector<int> tree(static_cast<size_t>(goal) + 1);
  std::iota(tree.begin(), tree.end(), 0);
  for (const Wall& wall : shuffled_walls(rooms_aside, random)) {
    const int a = tree[static_cast<size_t>(wall.room_a)], b = tree[static_cast<size_t>(wall.room_b)];
    const bool extra = uniform(random, 0.0, 1.0) < kExtraDoors;
    const bool closed = (a == b && !extra) || (!maze.open && wall.room_b == goal);
    if (closed)
      lay_wall(wall, rooms_aside, maze.walls);
    else
      std::replace(tree.begin(), tree.end(), b, a);
  }
  const double low = -0.5 * kRoomM, high = (rooms_aside - 0.5) * kRoomM, end = (rooms_aside - 1) * kRoomM;
  lay_stones({low, low}, {high, low}, maze.walls);
  lay_stones({low, high}, {high, high}, maze.walls);
  lay_stones({low, low}, {low, high}, maze.walls);
  lay_stones({high, low}, {high, high}, maze.walls);
  maze.path = {{0.0, 0.0}, {end, end}};
  return maze;
}

int max_visits(const std::vector<Pose2>& track) {
  std::map<std::pair<int, int>, int> visits;
  std::pair<int, int> last{-1, -1};
  for (const Pose2& pose : track) {
    const int x = static_cast<int>(std::lround(pose.x_m / kRoomM)),
              y = static_cast<int>(std::lround(pose.y_m / kRoomM));
    // Only the inner part of a room counts: a rover in a door is in neither.
    const bool inside = std::max(std::abs(pose.x_m - x * kRoomM), std::abs(pose.y_m - y * kRoomM)) < 0.3 * kRoomM;
    if (!inside || std::pair{x, y} == last) continue;
    last = {x, y};
    ++visits[last];
  }
  int most = 0;
  for (const auto& [room, count] : visits) most = std::max(most, count);
  return most;
}

std::string maze_problem(const Maze& maze, const DriveResult& result) {
  if (result.collided) return "collision";
  if (maze.open && !result.reached) return "not reached: " + result.text;
  if (!maze.open && result.text.rfind("no path:", 0) != 0) return "does not say that there is no path: " + result.text;
  if (const int visits = max_visits(result.track); visits > kMaxVisits)
    return "a room is entered " + std::to_string(visits) + " times";
  return "";
}

}  // namespace rover::planning::testing_support
