// rover_campaign: drives a campaign; shows and compares its rows. Its workers are this program too.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "common/bus/command_line.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/engine.hpp"
#include "tools/campaign/page/page_command.hpp"
#include "tools/campaign/worker.hpp"

namespace {

using namespace rover::campaign;

const std::map<std::string, Keep> kKeep = {{"none", Keep::kNone}, {"failures", Keep::kFailures}, {"all", Keep::kAll}};

std::string command_line(int argc, char** argv) {
  std::string text = "./rover campaign";
  for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
  return text;
}

void add_keep(CLI::App& app, Keep& keep) {
  app.add_option("--keep", keep, "run folders to keep: failures (without a log of more than 20 MB), all or none")
      ->transform(CLI::CheckedTransformer(kKeep, CLI::ignore_case).description(""))
      ->type_name("TEXT");
}

void add_options(CLI::App& app, CampaignArguments& campaign) {
  app.add_option("file", campaign.file, "campaign file, as config/campaigns/enav.yaml")
      ->transform(rover::is_user_path());
  app.add_option("--engine", campaign.engine, "parallel: GNU parallel; slurm: job arrays of a cluster")
      ->check(CLI::IsMember(engine_names()))
      ->capture_default_str();
  app.add_option("--jobs", campaign.jobs, "drives at the same time; default: one per core, with Slurm the cluster's")
      ->check(CLI::Range(1, 10'000));
  app.add_flag("--resume", campaign.resume, "continue the campaign in the folder");
  app.add_option("--out", campaign.out, "folder; default: logs/campaigns/NAME")->transform(rover::is_user_path());
  app.add_option("--sshloginfile", campaign.sshloginfile, "GNU parallel: machines, one SSH login a line")
      ->transform(rover::is_user_path())
      ->check(CLI::ExistingFile);
  add_keep(app, campaign.keep);
  app.add_option("--drive-program", campaign.drive_program)->transform(rover::is_user_path())->group("");  // tests
}

CLI::App* add_page(CLI::App& app, PageArguments& page) {
  CLI::App* command =
      app.add_subcommand("page", "answer of a campaign. Example: ./rover campaign page logs/campaigns/enav");
  command->add_option("dir", page.dir, "folder of the campaign")->required()->transform(rover::is_user_path());
  command->add_option("--out", page.out, "NAME.html or NAME.md; default: both, in the folder")
      ->transform(rover::is_user_path());
  return command;
}

CLI::App* add_compare(CLI::App& app, CompareArguments& compare) {
  CLI::App* command =
      app.add_subcommand("compare", "two campaigns, paired. Example: ./rover campaign compare logs/campaigns/{a,b}");
  command->add_option("dir_a", compare.dir_a, "folder of A")->required()->transform(rover::is_user_path());
  command->add_option("dir_b", compare.dir_b, "folder of B")->required()->transform(rover::is_user_path());
  command->add_option("--out", compare.out, "NAME.html or NAME.md; default: both, in the folder of B")
      ->transform(rover::is_user_path());
  return command;
}

CLI::App* add_job(CLI::App& app, WorkerArguments& worker) {
  CLI::App* command = app.add_subcommand("job", "one drive, begun by an engine")->group("");
  command->add_option("--dir", worker.dir)->required();
  command->add_option("--work", worker.work)->required();
  command->add_option("--attempt", worker.attempt);
  command->add_option("--min-free", worker.min_free_bytes);
  add_keep(*command, worker.keep);
  command->add_option("job", worker.job)->required();
  return command;
}

int begin(const CLI::App& app, const CampaignArguments& campaign) {
  if (campaign.file.empty()) throw rover::ConfigError("./rover campaign: a campaign file is required; see --help");
  if (!campaign.sshloginfile.empty() && campaign.engine != "parallel")
    throw rover::ConfigError("--sshloginfile: GNU parallel's alone; Slurm knows its machines");
  if (app.count("--drive-program") > 0 && !std::filesystem::exists(campaign.drive_program))
    throw rover::ConfigError(campaign.drive_program + ": no such file");
  return run_campaign(campaign);
}

}  // namespace

int main(int argc, char** argv) {
  CampaignArguments campaign;
  campaign.source_dir = rover::project_dir();
  campaign.bin_dir = std::filesystem::canonical("/proc/self/exe").parent_path();
  campaign.command = command_line(argc, argv);
  PageArguments page_arguments;
  CompareArguments compare_arguments;
  page_arguments.command = compare_arguments.command = campaign.command;
  WorkerArguments worker;
  bool print_needs = false;  // for the script ./rover, which builds the needed programs

  CLI::App app(
      "Drives a scenario over a product of axes and seeds; each drive is one job of an engine.\n"
      "Example: ./rover campaign config/campaigns/enav.yaml --jobs 2");
  app.name("./rover campaign");
  app.add_flag("--needs-full-level", print_needs)->group("");
  add_options(app, campaign);
  const CLI::App* page_command = add_page(app, page_arguments);
  const CLI::App* compare_command = add_compare(app, compare_arguments);
  const CLI::App* job_command = add_job(app, worker);
  try {
    rover::parse_arguments(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  }
  try {
    if (print_needs) return !campaign.file.empty() && needs_full_level(campaign) ? 0 : 1;
    if (job_command->parsed()) return do_job(worker);
    if (page_command->parsed()) return page(page_arguments);
    if (compare_command->parsed()) return compare_campaigns(compare_arguments);
    return begin(app, campaign);
  } catch (const rover::ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {  // filesystem_error
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
