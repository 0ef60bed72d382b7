#include "tools/config/parameter_files.hpp"

#include <gtest/gtest.h>

#include "common/bus/config.hpp"

namespace rover::config_tool {
namespace {

TEST(WithTable, ReplacesWhatIsBetweenTheMarkers) {
  EXPECT_EQ(with_table("# slam\n<!-- parameters -->\nold\n<!-- /parameters -->\nend\n", "| new |\n", "README.md"),
            "# slam\n<!-- parameters -->\n| new |\n<!-- /parameters -->\nend\n");
}

TEST(WithTable, ReadmeWithoutMarkersIsNamed) {
  try {
    with_table("# slam\n", "| new |\n", "slam/README.md");
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("slam/README.md: ")) << error.what();
  }
}

TEST(ParameterFiles, SharedParametersAreListedWithUnitAndRange) {
  const std::string text = parameters_of("navigation", "markdown");
  EXPECT_NE(text.find("| `goal_tolerance_m` | 0.5 | m | 0.05 to 5 |"), std::string::npos) << text;
}

}  // namespace
}  // namespace rover::config_tool
