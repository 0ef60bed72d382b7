#include <opencv2/imgcodecs.hpp>

#include "corpus.hpp"
#include "parsers.hpp"
#include "tools/calibration/read.hpp"
#include "tools/interchange/import_data_set.hpp"
#include "tools/interchange/stereo_data_set.hpp"

namespace rover::fuzz {
namespace {

const std::vector<std::string> kTableWords = {",", " ", "\t", "\r\n", "#", "1e3", "nan", "0", "\"", ";", "P0: "};

std::string picture() {
  const cv::Mat grey(24, 32, CV_8U, cv::Scalar(90));
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", grey, bytes);
  return {bytes.begin(), bytes.end()};
}

void run_data_set(const std::vector<Input>& corpus, const Input& input, Scratch& scratch) {
  lay_out(corpus, input, scratch);
  interchange::read_stereo_data_set(scratch.dir(), "", 10.0);
  interchange::ImportOptions options;
  options.data_set = scratch.dir();
  options.out = scratch.out();
  options.config_dir = ROVER_SOURCE_DIR "/config";
  interchange::import_data_set(options);
}

Parser data_set_parser(const std::string& name, std::vector<Input> corpus) {
  return {name, corpus, kTableWords,
          [corpus](const Input& input, Scratch& scratch) { run_data_set(corpus, input, scratch); }};
}

// Each file alone, and with a valid second one.
void run_calibration(const Input& input, Scratch& scratch) {
  const std::string file = scratch.write(input.name, input.bytes);
  calibration::read_calibration({file});
}

}  // namespace

Parser kitti_parser() {
  std::vector<Input> corpus = files_of("kitti");
  for (const char* name : {"image_0/000000.png", "image_0/000001.png", "image_0/000002.png", "image_0/000003.png",
                           "image_1/000000.png", "image_1/000001.png", "image_1/000002.png", "image_1/000003.png"})
    corpus.push_back({name, picture()});
  return data_set_parser("kitti", corpus);
}

Parser euroc_parser() {
  std::vector<Input> corpus = files_of("euroc");
  for (const char* camera : {"cam0", "cam1"})
    for (const char* name : {"1403636579763555584", "1403636579813555456", "1403636579863555584"})
      corpus.push_back({std::string(camera) + "/data/" + name + ".png", picture()});
  return data_set_parser("euroc", corpus);
}

Parser calibration_parser() {
  std::vector<std::string> words = yaml_words();
  words.insert(words.end(), {"!!opencv-matrix", "rows", "<data>", "</R>", "dt: d", "&lt;", "<!--"});
  return {"calibration", files_of("calibration"), words, run_calibration};
}

}  // namespace rover::fuzz
