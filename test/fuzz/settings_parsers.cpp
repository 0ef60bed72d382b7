#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/bus/yaml_file.hpp"
#include "corpus.hpp"
#include "mission_control/config.hpp"
#include "parsers.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "supervisor/config.hpp"
#include "tools/launcher/arguments.hpp"
#include "tools/launcher/run_folder.hpp"
#include "tools/orbital_planner/command.hpp"
#include "tools/report/config_difference.hpp"

namespace rover::fuzz {
namespace {

namespace fs = std::filesystem;

fs::path config_file(const std::string& name) {
  return fs::path(ROVER_SOURCE_DIR) / "config" / name;
}

void run_scenario(const Input& input, Scratch& scratch) {
  load_scenario(scratch.write("scenario.yaml", input.bytes));
}

std::vector<Input> settings_corpus() {
  std::vector<Input> corpus;
  for (const char* name : {"bus.yaml", "cameras.yaml", "fdir.yaml", "hazard_detector.yaml", "mission_control.yaml",
                           "navigation.yaml", "supervisor.yaml", "vehicle.yaml"})
    corpus.push_back({name, bytes_of(config_file(name))});
  corpus.push_back({"ground.yaml", bytes_of(fs::path(ROVER_SOURCE_DIR) / "examples" / "driver" / "ground.yaml")});
  return corpus;
}

void run_settings(const std::vector<Input>& corpus, const Input& input, Scratch& scratch) {
  lay_out(corpus, input, scratch);
  const std::string dir = scratch.dir();
  report::config_differences({{input.name, input.bytes}}, {});
  const Vehicle vehicle = load_vehicle(dir);
  load_stereo_rig(dir, "loccam");
  load_stereo_rig(dir, "navcam");
  load_mission_plan(dir);
  mission::load_config(dir);
  mission::page_setup(dir, vehicle);
  supervisor::load_config(dir);
}

void run_arguments(const Input& input, Scratch& scratch) {
  const std::string text = input.bytes.c_str();  // as program arguments, up to the first NUL
  const fs::path config = fs::path(scratch.out());
  fs::create_directories(config);
  fs::copy_file(config_file("vehicle.yaml"), config / "vehicle.yaml");
  read_or_refuse([&] { apply_setting(text, config); });
  load_yaml(config / "vehicle.yaml");  // must still be valid
  read_or_refuse([&] { parse_seeds(text); });
  read_or_refuse([&] { orbital::parse_place(text, "--start"); });
  read_or_refuse([&] { user_path(text); });
  read_or_refuse([&] { reports_url(text); });
  if (const std::string problem = bus_url_problem(text); !problem.empty()) throw ConfigError(problem);
}

}  // namespace

Parser scenario_parser() {
  std::vector<Input> corpus = files_of("scenario");
  for (const char* name : {"flat.yaml", "slope.yaml"})
    corpus.push_back({name, bytes_of(config_file("scenarios") / name)});
  return {"scenario", corpus, yaml_words(), run_scenario};
}

Parser settings_parser() {
  const std::vector<Input> corpus = settings_corpus();
  return {"settings", corpus, yaml_words(),
          [corpus](const Input& input, Scratch& scratch) { run_settings(corpus, input, scratch); }};
}

Parser arguments_parser() {
  return {"arguments", files_of("arguments"), yaml_words(), run_arguments};
}

}  // namespace rover::fuzz
