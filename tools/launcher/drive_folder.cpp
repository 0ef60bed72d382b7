#include "tools/launcher/drive_folder.hpp"

#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/geo/elevation_map.hpp"
#include "common/geo/elevation_map_file.hpp"
#include "common/geo/geotiff_writer.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

std::string config_dir_of(const DriveArguments& arguments) {
  return arguments.config_dir.empty() ? arguments.source_dir + "/config" : arguments.config_dir;
}

std::string ground_of(const DriveArguments& arguments) {
  return arguments.ground.empty() ? config_dir_of(arguments) + "/ground.yaml" : arguments.ground;
}

void check_inputs(const DriveArguments& arguments) {
  const std::string config_dir = config_dir_of(arguments);
  if (const std::string problem = folder_problem(config_dir); !problem.empty())
    throw ConfigError(config_dir + ": " + problem);
  const std::string ground = ground_of(arguments);
  if (const std::string problem = file_problem(ground); !problem.empty())
    throw ConfigError(ground + ": " + problem + ". It contains the start pose and the path; start from a copy of " +
                      "examples/driver/ground.yaml and select it with --ground");
}

// Written in metres, so that all readers of the run folder agree. A large map must be so already: it is linked.
void place_map(const std::string& file, RunFolder& folder) try {
  const std::string placed = folder.dir + "/orbital_map.tif";
  if (is_large_map(file)) {
    const ElevationMapFile check(file);
    fs::create_symlink(fs::canonical(file), placed);
    folder.map_notes = {file + ": not copied, the run's folder refers to it"};
    return;
  }
  ElevationMap map = read_elevation_map(file);
  require_no_voids(map, file);
  write_geotiff(placed, map.raster);
  folder.map_notes = std::move(map.notes);
} catch (const DtmError& error) {
  throw ConfigError("--map " + std::string(error.what()));
}

// On the map's ground, in its projection.
void place_picture(const std::string& file, const RunFolder& folder) try {
  const ElevationMapFile map(folder.dir + "/orbital_map.tif");
  write_geotiff(folder.dir + "/orbital_picture.tif", read_picture(file, map.frame()));
} catch (const DtmError& error) {
  throw ConfigError("--picture " + std::string(error.what()));
}

void fill(const DriveArguments& arguments, RunFolder& folder) {
  copy_configuration(config_dir_of(arguments), folder.config_dir);
  fs::copy_file(ground_of(arguments), fs::path(folder.config_dir) / "ground.yaml",
                fs::copy_options::overwrite_existing);
  if (!arguments.map.empty()) place_map(arguments.map, folder);
  if (!arguments.picture.empty()) place_picture(arguments.picture, folder);
  folder.bus_url = arguments.bus;
  apply_settings(arguments.headless, arguments.record, arguments.set, folder);
}

}  // namespace

RunFolder make_drive_folder(const DriveArguments& arguments) {
  check_inputs(arguments);
  RunFolder folder = create_folders(arguments.source_dir, arguments.out, "drive");
  try {
    fill(arguments, folder);
  } catch (const std::exception& error) {
    remove_run_folder(folder);
    throw ConfigError(in_users_files(error.what(), folder, arguments));
  }
  return folder;
}

std::string in_users_files(std::string message, const RunFolder& folder, const DriveArguments& arguments) {
  message = without_lines(message, folder);
  const std::string ground = folder.config_dir + "/ground.yaml";
  if (const size_t at = message.find(ground); at != std::string::npos)
    message.replace(at, ground.size(), ground_of(arguments));
  return in_users_files(message, folder, config_dir_of(arguments));
}

}  // namespace rover
