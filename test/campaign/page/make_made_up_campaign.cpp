// make_made_up_campaign DIR [IMPROVEMENT]: the folder of a campaign of some 3,000 drives that nobody drove, to see its
// page.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "made_up_campaign.hpp"
#include "tools/campaign/store.hpp"

int main(int argc, char** argv) {
  using namespace rover::campaign;
  if (argc < 2) return 2;
  const std::string dir = argv[1];
  std::filesystem::create_directories(dir);
  const std::vector<Row> rows = made_up_rows({.seeds = 34, .improvement = argc > 2 ? std::atof(argv[2]) : 0.0});
  write_jobs(dir, made_up_jobs(rows));
  std::ofstream(dir + "/campaign.yaml") << "# made up\nscenario: enav\nseeds: 1..34\n";
  std::ofstream(dir + "/campaign.json")
      << R"({"name": "enav", "commit": "0123456789ab", "command": "./rover campaign enav.yaml", "drive_program": ""})";
  Store::create(dir).add(rows);
  return 0;
}
