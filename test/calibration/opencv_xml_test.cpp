#include "tools/calibration/opencv_xml.hpp"

#include <gtest/gtest.h>

#include "common/bus/config.hpp"
#include "wild.hpp"

namespace rover::calibration {
namespace {

std::string refusal(const std::string& text) {
  try {
    (void)parse_opencv_xml(text, "c.xml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::string storage(const std::string& inner) {
  return "<?xml version=\"1.0\"?>\n<opencv_storage>\n" + inner + "</opencv_storage>\n";
}

TEST(OpenCvXml, MatricesListsAndTexts) {
  const YAML::Node root = parse_opencv_xml(
      storage("<!-- 2 cameras -->\n<M1 type_id=\"opencv-matrix\"><rows>1</rows><data>\n 500. 0.\n 1e-3</data></M1>\n"
              "<files><_>a</_><_>b</_></files><model>pinhole</model><none></none>\n"),
      "c.xml");
  EXPECT_EQ(root["M1"]["data"].size(), 3U);
  EXPECT_EQ(root["M1"]["data"][2].Scalar(), "1e-3");
  EXPECT_EQ(root["files"][1].Scalar(), "b");
  EXPECT_EQ(root["model"].Scalar(), "pinhole");
  EXPECT_EQ(root["none"].size(), 0U);
}

TEST(OpenCvXml, TruncatedOrAmbiguousXmlIsRefusedByLine) {
  const std::string cut = refusal("<?xml version=\"1.0\"?>\n<opencv_storage>\n<M2 type_id=");
  EXPECT_EQ(cut.rfind("c.xml:3: not valid XML", 0), 0U) << cut;
  wild_row("Calibrations", "OpenCV: XML that is cut within an attribute (opencv issues 25946, 15127)",
           "a segmentation fault of OpenCV's", cut);
  EXPECT_EQ(refusal(storage("<R>1</R><R>2</R>")).rfind("c.xml:3: not valid XML: R: given twice", 0), 0U);
  EXPECT_NE(refusal(storage("<R><_>1</_><a>2</a></R>")).find("items of a list beside keys"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_NE(refusal(storage(deep)).find("levels deep"), std::string::npos);
  EXPECT_EQ(refusal("<html></html>"), "c.xml: not XML as OpenCV writes it");
}

}  // namespace
}  // namespace rover::calibration
