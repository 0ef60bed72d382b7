// make_synthetic_run DIR: a run folder with report, to inspect its pictures without a simulator.
#include <cmath>
#include <filesystem>

#include "rover_simulator/world/world.hpp"
#include "synthetic_run.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/make_report.hpp"

using namespace rover::report;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::filesystem::create_directories(argv[1]);
  rover::ElevationRaster dtm = rover::plane_raster(120.0, 90.0, 1.0, 0.02, 0.7);
  for (int j = 0; j < dtm.height; ++j)
    for (int i = 0; i < dtm.width; ++i)
      dtm.at(i, j) += static_cast<float>(1.5 * std::sin(0.07 * i + 0.05 * j) + 0.7 * std::sin(0.16 * j - 0.12 * i));
  rover::WorldConfig config;
  const rover::World world(config, dtm, 3);
  SyntheticRun run;
  run.planned = {{20, 30}, {40, 36}, {60, 52}, {95, 60}};
  run.swerves_m = {12, 23, 24.5, 38, 51, 63, 75};
  run.height_m = [&](double x, double y) { return world.smooth_height_m(x, y); };
  TrueWorld truth;
  for (const rover::Rock& rock : world.rocks_in(5, 15, 110, 75))
    truth.rocks.push_back({rock.x_m, rock.y_m, 0.5 * rock.diameter_m, rock.height_m});
  truth.height_m = [&](double x, double y) { return world.height_m(x, y); };
  for (const double at : run.swerves_m) {
    const Eigen::Vector2d p = part_ahead(run.planned, run.planned.front(), at).back();
    truth.rocks.push_back({p.x(), p.y(), 0.2, 0.24});
  }
  run.rocks = truth.rocks;
  write_synthetic_run(run, argv[1]);
  Study study;
  study.folder = open_run_folder(argv[1], ROVER_SOURCE_DIR "/config");
  study.log = rover::choose_run(study.folder.log);
  study.run = read_log(study.log);
  study.world = truth;
  rover::ElevationRaster orbital = world.orbital_map(1.0);
  study.orbital = {orbital.width, orbital.height, orbital.resolution_m, orbital.z_m};
  study.evaluation = evaluate(study.run, study.folder.info, study.folder.footprint, study.world);
  std::puts(write_report(study).c_str());
}
