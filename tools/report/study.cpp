#include "tools/report/study.hpp"

#include <fmt/format.h>

#include "tools/report/camera_picture.hpp"
#include "tools/report/camera_reader.hpp"
#include "tools/report/elevation_picture.hpp"
#include "tools/report/level_picture.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/map_layers.hpp"
#include "tools/report/map_picture.hpp"
#include "tools/report/no_truth.hpp"
#include "tools/report/oracle_evaluation.hpp"
#include "tools/report/run_plots.hpp"
#include "tools/report/world_truth.hpp"

namespace rover::report {
namespace {

constexpr double kAroundM = 15.0;  // margin around track and planned path

Box surroundings(const RunRecord& run) {
  Points track;
  for (const TruthSample& sample : run.truth) track.emplace_back(sample.T_map_body.translation().head<2>());
  std::vector<Points> lines{track};
  for (const PathRecord& path : run.global_paths) lines.push_back(path.points);
  return bounds(lines).expanded(kAroundM);
}

std::vector<std::string> draw_cameras(const Study& study) {
  std::vector<double> exposures_s;
  for (const Incident& incident : study.evaluation.incidents)
    exposures_s.push_back(exposure_behind(study.run, incident.t_s));
  std::vector<std::string> out;
  for (const auto& picture : read_camera_pictures(study.log, exposures_s))
    out.push_back(picture ? draw_camera(*picture, study.run, study.folder.footprint.origin_height_m) : "");
  return out;
}

}  // namespace

Study study_run(const std::string& run_dir, const std::string& default_config_dir, int log_run) {
  Study study;
  study.folder = open_run_folder(run_dir, default_config_dir);
  study.log = choose_run(study.folder.log, log_run);
  print_remarks(study.log);
  study.run = read_log(study.log, study.folder.info.sim_s);
  study.world = load_true_world(study.folder, surroundings(study.run));
  study.orbital = load_orbital_map(study.folder);
  const bool true_run = !study.run.truth.empty();
  if (!true_run) study.run = with_estimate_for_truth(study.run);
  study.evaluation = evaluate(study.run, study.folder.info, study.folder.footprint, study.world);
  if (true_run) evaluate_oracle(study.run, study.folder.vehicle, study.world, study.evaluation);
  if (!true_run) leave_out_truth_figures(study.evaluation.metrics);
  return study;
}

Pictures draw_pictures(const Study& study) {
  const Scene scene = study.scene();
  Pictures pictures;
  pictures.map = draw_map(scene);
  for (size_t i = 0; i < study.evaluation.incidents.size(); ++i) pictures.incidents.push_back(draw_incident(scene, i));
  pictures.cameras = draw_cameras(study);
  pictures.elevation = draw_elevation(scene);
  pictures.levels = draw_levels(scene);
  pictures.states = draw_state_timeline(scene);
  const PlotMarks marks = incident_marks(scene);
  const std::vector<Plot> plots = run_plots(scene);
  for (size_t i = 0; i < plots.size(); ++i)
    pictures.plots.push_back(
        draw_plot(plots[i], marks, study.evaluation.metrics.driven_length_m, fmt::format("plot-{}", i)));
  return pictures;
}

}  // namespace rover::report
