#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"
#include "tools/launcher/bench_command.hpp"
#include "tools/launcher/drive_command.hpp"
#include "tools/launcher/inject_command.hpp"
#include "tools/launcher/needed_programs.hpp"
#include "tools/launcher/replay_command.hpp"
#include "tools/launcher/run_command.hpp"
#include "tools/status/status_command.hpp"

namespace {

std::string command_line(int argc, char** argv) {
  std::string text = "./rover";
  for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
  return text;
}

void add_run_options(CLI::App& command, rover::RunArguments& run) {
  command.add_option("--level", run.level, "autonomy level: efficient, auto or full; default: the scenario's")
      ->check(CLI::IsMember({"auto", "efficient", "full"}));
  command
      .add_option(
          "--perception", run.perception,
          "rendered: cameras; geometric: rays with errors like those of stereo, faster; truth: for benches only")
      ->check(CLI::IsMember({"rendered", "geometric", "truth"}))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--cpu-scale", [&run](const std::string& scale) { run.set.push_back("navigation.cpu_scale=" + scale); },
          "how many times slower the modelled computer is; default: 1")
      ->check(CLI::Range(1.0, 100.0));
  rover::repeatable(
      command.add_option("--set", run.set, "set a value of the configuration: file.key=value, repeatable"));
}

void add_status_options(CLI::App& command, rover::status::StatusArguments& status) {
  CLI::Option* json = command.add_flag("--json", status.json, "one JSON document");
  command.add_flag("--watch", status.watch, "repeat every second until Ctrl-C")->excludes(json);
  command.add_option("--run", status.target.run, "run folder; default: the newest running one in logs/")
      ->transform(rover::is_user_path());
  command.add_option("--bus", status.target.bus, "LCM URL; default: that of the run")->check(rover::is_bus_url());
}

CLI::App* add_inject_command(CLI::App& app, rover::InjectArguments& inject) {
  CLI::App* command =
      app.add_subcommand("inject", "inject a fault into a running system. Example: ./rover inject drop VO");
  command->add_option("fault", inject.fault, "one of --list");
  command->add_option("target", inject.target, "service, CHANNEL, CHANNEL.field, wheel ...; see --list");
  command->add_option("--amount", inject.amount, "in the fault's unit; default: see --list");
  command->add_option("--for", inject.for_s, "duration in seconds of message time; default: until the end");
  command->add_option("--run", inject.run_dir, "run folder; default: the newest running one")
      ->transform(rover::is_user_path());
  command->add_flag("--list", inject.list, "list the faults");
  inject.source_dir = rover::project_dir();
  return command;
}

CLI::App* add_replay_command(CLI::App& app, rover::ReplayArguments& replay) {
  CLI::App* command = app.add_subcommand(
      "replay", "play a log back. Example: ./rover replay logs/RUN --services stereo,visual_odometry --speed 2");
  command->add_option("log", replay.log, "log file or run folder")->required()->transform(rover::is_user_path());
  rover::add_log_run(*command, replay.log_run);
  rover::repeatable(command->add_option("--services", replay.services,
                                        "services to run live; their logged messages are muted; all: every service"))
      ->delimiter(',');
  CLI::Option* check =
      command->add_flag("--check", replay.check, "compare the services' messages with the log, byte by byte");
  command->add_option("--from", replay.from_s, "begin at this message time [s]")
      ->check(rover::not_negative())
      ->excludes(check);
  command->add_option("--until", replay.until_s, "end at this message time [s]")->check(rover::not_negative());
  command->add_option("--speed", replay.speed, "times real time, or max")->excludes(check)->capture_default_str();
  command->add_flag("--loop", replay.loop, "repeat until q or Ctrl-C")->excludes(check);
  command
      ->add_option("--config", replay.config_dir,
                   "configuration folder; default: that of the log's run, else the project's")
      ->transform(rover::is_user_path());
  rover::repeatable(
      command->add_option("--set", replay.run.set, "set a value of the configuration: file.key=value, repeatable"));
  command->add_option("--out", replay.run.out, "folder of the replay; default: logs/<time>-replay-<log>")
      ->transform(rover::is_user_path());
  command->add_option("--bus", replay.run.bus, "LCM URL; default: of the configuration")->check(rover::is_bus_url());
  return command;
}

CLI::App* add_drive_command(CLI::App& app, rover::DriveArguments& drive) {
  CLI::App* command = app.add_subcommand(
      "drive", "run the stack with a vehicle's drivers. Example: ./rover drive --ground ground.yaml --map map.tif");
  command->add_option("--config", drive.config_dir, "folder of the configuration; default: config")
      ->transform(rover::is_user_path());
  command->add_option("--ground", drive.ground, "start pose and path; default: ground.yaml of the configuration")
      ->transform(rover::is_user_path());
  CLI::Option* map =
      command
          ->add_option("--map", drive.map, "orbital map (GeoTIFF) for the page, the report and the Full level's fixes")
          ->transform(rover::is_user_path());
  command->add_option("--picture", drive.picture, "picture from orbit of the map's ground, to localize on plains")
      ->needs(map)
      ->transform(rover::is_user_path());
  command->add_option("--bus", drive.bus, "LCM URL; default: of bus.yaml")->check(rover::is_bus_url());
  command->add_option("--out", drive.out, "folder of the run; default: logs/<time>-drive")
      ->transform(rover::is_user_path());
  command->add_option("--record", drive.record, "full or reduced")->check(CLI::IsMember({"full", "reduced"}));
  command->add_option("--timeout", drive.timeout_s, "timeout for the driver's first TICK [s]")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command->add_option("--level", drive.level, "autonomy level: efficient, or auto: Full where required")
      ->check(CLI::IsMember({"auto", "efficient"}))
      ->capture_default_str();
  command->add_flag("--headless", drive.headless, "no page");
  command->add_flag("--until-goal", drive.until_goal, "end at the goal without a stop command");
  rover::repeatable(
      command->add_option("--set", drive.set, "set a value of the configuration: file.key=value, repeatable"));
  return command;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("./rover: guidance, navigation and control of a planetary rover");
  app.name("./rover");
  app.require_subcommand(1);
  bool print_needs = false;  // for the script ./rover, which builds the needed programs
  app.add_flag("--needs-full-level", print_needs)->group("");
  rover::RunArguments run;
  run.source_dir = rover::project_dir();
  run.bin_dir = std::filesystem::canonical("/proc/self/exe").parent_path();

  CLI::App* run_command = app.add_subcommand("run", "drive a scenario to its goal. Example: ./rover run --seed 3");
  run_command->add_option("scenario", run.scenario, "scenario file; default: config/scenarios/default.yaml")
      ->transform(rover::is_user_path());
  run_command->add_option("--seed", run.seed, "seed of rocks, noise and errors; default: the scenario's")
      ->check(rover::not_negative());
  run_command->add_option("--out", run.out, "folder of the run; default: logs/<time>-<scenario>")
      ->transform(rover::is_user_path());
  run_command->add_option("--bus", run.bus, "LCM URL; default: of config/bus.yaml")->check(rover::is_bus_url());
  run_command->add_option("--record", run.record, "full or reduced")->check(CLI::IsMember({"full", "reduced"}));
  run_command->add_flag("--headless", run.headless, "no page");
  run_command->add_flag("--allow-injection", run.allow_injection, "allow ./rover inject in this run");
  run_command->add_flag("--realtime", run.realtime, "pace by the clock instead of lockstep");
  add_run_options(*run_command, run);

  rover::BenchArguments bench;
  CLI::App* bench_command = app.add_subcommand("bench", "measure. Example: ./rover bench seed --seeds 1..10 --resume");
  bench_command->add_option("suite", bench.suite, "seed: both seed traverses; default: the default scenario")
      ->capture_default_str();
  bench_command->add_option("--seeds", bench.seeds,
                            "a range like 1..10 or a list like 1,4,7; default: 1..10 of seed, 201..240 of default");
  bench_command->add_flag("--resume", bench.resume, "keep the rows of the same commit, level and settings");
  bench_command->add_option("--jobs", bench.jobs, "parallel runs")->check(CLI::Range(1, 64))->capture_default_str();
  add_run_options(*bench_command, run);

  rover::status::StatusArguments status;
  status.target.logs_dir = run.source_dir + "/logs";
  CLI::App* status_command = app.add_subcommand("status", "status of a running rover. Example: ./rover status --watch");
  add_status_options(*status_command, status);

  rover::InjectArguments inject;
  CLI::App* inject_command = add_inject_command(app, inject);

  rover::ReplayArguments replay;
  replay.run.source_dir = run.source_dir;
  replay.run.bin_dir = run.bin_dir;
  CLI::App* replay_command = add_replay_command(app, replay);

  rover::DriveArguments drive;
  drive.source_dir = run.source_dir;
  drive.bin_dir = run.bin_dir;
  CLI::App* drive_command = add_drive_command(app, drive);

  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  try {
    if (print_needs) {
      const bool full = (run_command->parsed() && rover::needs_full_level(run)) ||
                        (drive_command->parsed() && rover::needs_full_level(drive)) ||
                        (replay_command->parsed() && rover::needs_full_level(replay));
      return full ? 0 : 1;
    }
    if (status_command->parsed()) return rover::status::show_status(status);
    if (run_command->parsed()) return rover::run(run).exit_status;
    if (drive_command->parsed()) return rover::drive(drive);
    if (inject_command->parsed()) return rover::inject(inject);
    if (replay_command->parsed()) return rover::replay_log(replay);
    bench.run = run;
    bench.command = command_line(argc, argv);
    return rover::bench(bench);
  } catch (const rover::ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {  // filesystem_error
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
