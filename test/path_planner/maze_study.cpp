// Drives random mazes (maze.hpp) and prints what is wrong in each: a tool; closed_loop_test drives a few.
//   maze_study [first seed] [last seed] [rooms aside] [efficient | full]
#include <cstdio>
#include <cstdlib>

#include "test/path_planner/maze.hpp"

int main(int argc, char** argv) {
  using namespace rover::planning::testing_support;
  const int first = argc > 1 ? std::atoi(argv[1]) : 1;
  const int last = argc > 2 ? std::atoi(argv[2]) : 20;
  const int aside = argc > 3 ? std::atoi(argv[3]) : 4;
  DriveConfig config;
  config.planner = planner_config();
  config.full = argc > 4 && std::string(argv[4]) == "full";
  config.timeout_s = 4000.0;
  int wrong = 0;
  for (int seed = first; seed <= last; ++seed) {
    const Maze maze = random_maze(aside, static_cast<std::uint64_t>(seed));
    const DriveResult r = drive(config, maze.walls, maze.path, static_cast<std::uint64_t>(seed));
    const std::string problem = maze_problem(maze, r);
    wrong += problem.empty() ? 0 : 1;
    std::printf("maze %4d %s: driven %5.1f m in %4.0f s, back-ups %d, rooms entered at most %d times%s%s\n", seed,
                maze.open ? "open  " : "closed", r.driven_m, r.duration_s, r.back_ups, max_visits(r.track),
                problem.empty() ? "" : "; WRONG: ", problem.c_str());
    std::fflush(stdout);
  }
  std::printf("%d of %d mazes wrong\n", wrong, last - first + 1);
  return wrong == 0 ? 0 : 1;
}
