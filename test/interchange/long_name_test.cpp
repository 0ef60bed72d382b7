// Found by the fuzzer: a name that is too long for any file system.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "tools/interchange/stereo_data_set.hpp"
#include "wild.hpp"

namespace rover::interchange {
namespace {

namespace fs = std::filesystem;

TEST(LongName, OfAPictureIsRefusedInOneLine) {
  const testing_support::TempFolder folder;
  fs::copy(ROVER_SOURCE_DIR "/test/fuzz/corpus/euroc", folder.path(), fs::copy_options::recursive);
  for (const char* camera : {"cam0", "cam1"})
    std::ofstream(folder.path() / camera / "data.csv")
        << "#timestamp [ns],filename\n1403636579763555584," + std::string(5000, 'p') + ".png\n";
  try {
    read_stereo_data_set(folder.path().string(), "", 10.0);
    FAIL() << "taken";
  } catch (const ConfigError& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("File name too long"), std::string::npos) << refusal.what();
    EXPECT_LE(std::string(refusal.what()).size(), 2000U);
    wild_row("Data sets", "EuRoC: a picture's name of 5,000 characters", "an exception of the file system's",
             "refused: File name too long");
  }
}

}  // namespace
}  // namespace rover::interchange
