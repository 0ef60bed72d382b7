// Real-world data sets: each is imported with a count of skipped data, or refused with file and line.
#include <fmt/format.h>

#include "data_set_fixture.hpp"
#include "test/wild.hpp"

namespace rover::interchange {
namespace {

const char* kIdentity = "1 0 0 0 0 1 0 0 0 0 1 ";

class WildImport : public ImportTest {
 protected:
  // Images with these names in both folders; left image n has grey value n.
  void make_pictures(const std::vector<std::string>& names) {
    for (size_t i = 0; i < names.size(); ++i)
      for (const char* folder : {"image_0", "image_1"}) write_picture(data_ / folder / names[i], static_cast<int>(i));
    write_text(data_ / "calib.txt", "P0: 700 0 32 0 0 701 24 0 0 0 1 0\nP1: 700 0 32 -350 0 701 24 0 0 0 1 0\n");
  }
  // Row i is i metres ahead.
  static std::string poses(int rows) {
    std::string text;
    for (int i = 0; i < rows; ++i) text += kIdentity + std::to_string(i) + "\n";
    return text;
  }
  static std::vector<std::string> numbered(int first, int last, const char* format = "{:06}.png") {
    std::vector<std::string> names;
    for (int i = first; i <= last; ++i) names.push_back(fmt::format(fmt::runtime(format), i));
    return names;
  }
  // "5 pairs, from 000010.png at 10 m; skipped: ...", or the refusal.
  std::string outcome() {
    try {
      const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
      const StereoPair& first = set.pairs.front();
      std::string text = fmt::format("{} pairs, from {}", set.pairs.size(), fs::path(first.left).filename().string());
      if (first.T_map_body) text += fmt::format(" at {:.0f} m", first.T_map_body->translation().x());
      for (const auto& [what, count] : set.skipped)
        if (count > 0) text += fmt::format("; skipped: {} {}", count, what);
      for (const std::string& note : set.notes) text += "; " + note;
      return text;
    } catch (const ConfigError& error) {
      return error.what();
    }
  }
  void expect(const std::string& input, const std::string& before, const std::string& part) {
    expect_said(input, before, outcome(), part);
  }
  void expect_said(const std::string& input, const std::string& before, std::string now, const std::string& part) {
    EXPECT_NE(now.find(part), std::string::npos) << input << ": " << now;
    EXPECT_EQ(now.find('\n'), std::string::npos) << now;
    const std::string place = folder_.path().string() + "/";
    for (size_t at; (at = now.find(place)) != std::string::npos;) now.erase(at, place.size());
    wild_row("Data sets", input, before, now);
  }
  // EuRoC's lists with these times, the pictures a.png, b.png ... of them, and truth at each time of the left camera.
  void make_lists(const std::vector<std::string>& left, const std::vector<std::string>& right) {
    make_euroc();
    for (const auto& [camera, times] : {std::pair("cam0", left), std::pair("cam1", right)}) {
      std::string list = "#timestamp [ns],filename\n";
      for (size_t i = 0; i < times.size(); ++i) {
        const std::string name = std::string(1, static_cast<char>('a' + i)) + ".png";
        list += times[i] + "," + name + "\n";
        write_picture(data_ / "mav0" / camera / "data" / name, 50);
      }
      write_text(data_ / "mav0" / camera / "data.csv", list);
    }
    fs::remove_all(data_ / "mav0/state_groundtruth_estimate0");
  }
  fs::path truth_file() const { return data_ / "mav0/state_groundtruth_estimate0/data.csv"; }
};

TEST_F(WildImport, KittisPicturesGoByTheirNumbers) {
  make_pictures(numbered(0, 11, "{}.png"));
  const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
  ASSERT_EQ(set.pairs.size(), 12U);
  for (size_t i = 0; i < 12; ++i) EXPECT_EQ(fs::path(set.pairs[i].left).filename(), std::to_string(i) + ".png");
  expect("KITTI: names without leading zeros: 0, 1, ..., 10, 11", "sorted 0, 1, 10, 11, 2", "12 pairs, from 0.png");
}

TEST_F(WildImport, KittisPosesAndTimesAreThoseOfTheNumbers) {
  make_pictures(numbered(10, 14));
  write_text(data_ / "poses.txt", poses(15));
  std::string times;
  for (int i = 0; i < 15; ++i) times += fmt::format("{}\n", 0.1 * i * i);
  write_text(data_ / "times.txt", times);
  expect("KITTI: the first ten pictures cut away, all poses kept", "poses given to the wrong pictures",
         "5 pairs, from 000010.png at 10 m");
  EXPECT_EQ(read_stereo_data_set(data_.string(), "", 10.0).pairs[1].since_first, 2'100'000) << "10.0 s and 12.1 s";
  write_text(data_ / "poses.txt", poses(5));
  expect("KITTI: the first ten pictures and poses cut away", "taken", "5 pairs, from 000010.png at 0 m");
  write_text(data_ / "poses.txt", poses(7));
  expect("KITTI: seven poses for the pictures 10 to 14", "poses given to the wrong pictures",
         "poses.txt: 7 rows for the images 10 to 14");
  write_text(data_ / "poses.txt", poses(4));
  expect("KITTI: fewer poses than pictures", "refused", "poses.txt: 4 rows");
  write_text(data_ / "poses.txt", poses(20));
  write_text(data_ / "times.txt", "0.1\n0.2\n0.3\n");
  expect("KITTI: fewer times than pictures", "refused", "times.txt: 3 rows");
}

TEST_F(WildImport, OtherFilesAreSkippedAndCounted) {
  make_pictures(numbered(0, 3));
  write_text(data_ / "image_0" / "._000000.png", "of another system");
  write_text(data_ / "image_1" / ".DS_Store", "of another system");
  write_text(data_ / "image_0" / "Thumbs.db", "of another system");
  expect("KITTI: ._x.png, .DS_Store and Thumbs.db of other systems", "taken for a picture; pairs shifted",
         "4 pairs, from 000000.png; skipped: 1 files that are neither PNG nor JPEG; skipped: 2 hidden files");
  fs::remove(data_ / "image_1" / "000002.png");
  expect("KITTI: a right picture is missing", "left out", "1 pictures without a partner");
  fs::rename(data_ / "image_0" / "000003.png", data_ / "image_0" / "000003.PNG");
  expect("KITTI: .PNG", "left out without a word", "3 pairs");
  write_picture(data_ / "image_0" / "3.jpg", 1);
  expect("KITTI: two pictures of one number", "pairs shifted", "has the number of");
  fs::remove(data_ / "image_0" / "3.jpg");
  write_picture(data_ / "image_0" / "last.png", 1);
  expect("KITTI: a picture without a number", "sorted among the others", "last.png: no number in the name");
  fs::remove_all(data_ / "image_0");
  fs::create_directories(data_ / "image_0");
  expect("KITTI: an empty folder", "'holds no sequence of stereo pairs'", "image_0: no pictures");
}

TEST_F(WildImport, KittisFilesAreReadLineByLine) {
  const auto with = [&](const char* file, const std::string& text) {
    make_pictures(numbered(0, 2));
    for (const char* other : {"poses.txt", "times.txt"}) fs::remove(data_ / other);
    write_text(data_ / file, text);
  };
  with("times.txt", "1317376155.0\n1317376155.1\n1417376155.2\n");
  expect("KITTI: a time that jumps by years", "endless ticks written", "times.txt:3: 100000000.1");
  with("times.txt", "1317376155000\n1317376255000\n1317376355000\n");
  expect("KITTI: times in milliseconds", "endless ticks written", "times.txt:1: one time in seconds");
  with("times.txt", "2011-09-26 13:02:25.964\n");
  expect("KITTI: times of the raw layout", "'0 times for 3 pictures'", "times.txt:1: '2011-09-26' is not a number");
  with("times.txt", "0\n0.1\nnan\n");
  expect("KITTI: a time that is not a number", "'2 times for 3 pictures'", "times.txt:3: one time in seconds");
  with("poses.txt", "\xef\xbb\xbf" + std::string(kIdentity) + "0\r\n" + kIdentity + "1\r\n" + kIdentity + "2\r\n");
  expect("KITTI: poses with the mark of UTF-8 and CRLF", "refused", "3 pairs, from 000000.png at 0 m");
  with("poses.txt", poses(1) + "nan nan nan nan nan nan nan nan nan nan nan nan\n" + kIdentity + "2\n");
  expect("KITTI: a row of NaN among the poses", "refused", "skipped: 1 rows of the ground truth that are not a number");
  with("poses.txt", "0.0 1 2 3 0 0 0 1\n");
  expect("KITTI: poses in the format of TUM (evo issue 218)", "'not twelve numbers'",
         "poses.txt:1: 8 columns; the twelve");
  with("poses.txt", poses(2) + "2 0 0 0 0 2 0 0 0 0 2 0\n");
  expect("KITTI: poses with a scale", "taken", "poses.txt:3: the left 3 x 3");
  const char* row = "700 0 32 0 0 701 24 0 0 0 1 0\n";
  with("calib.txt",
       std::string("Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\nP0: ") + row + "P1: 700 0 32 -350 0 701 24 0 0 0 1 0\n");
  expect("KITTI: Tr before P0 in calib.txt", "Tr taken for P0", "3 pairs");
  with("calib.txt", std::string("P0: 700 0 32 -350 0 701 24 0 0 0 1 0\nP1: ") + row);
  expect("KITTI: P0 and P1 exchanged", "'no stereo pair'", "calib.txt: the second camera is not to the right");
  with("calib.txt", std::string("P0: ") + row + "P1: 700 0 32 -350000 0 701 24 0 0 0 1 0\n");
  expect("KITTI: a baseline in millimetres", "taken", "calib.txt: a baseline of 500 m");
}

TEST_F(WildImport, KittisRawLayoutIsRefusedByName) {
  write_text(data_ / "image_00/timestamps.txt", "2011-09-26 13:02:25.964389445\n");
  expect("KITTI's raw layout (image_00/data)", "'neither KITTI's layout'",
         "KITTI's raw layout (image_00), which is not read");
}

TEST_F(WildImport, EurocsTimes) {
  make_lists({"1000000000", "1050000000", "1100000000"}, {"1000001000", "1049998000", "1100000000"});
  expect("EuRoC: left and right differ by a microsecond or two", "no pair",
         "3 pairs, from a.png; the two images of a pair are up to 2 us apart");
  make_lists({"1000000000", "1050000000", "1100000000"}, {"1025000000", "1075000000", "1125000000"});
  expect("EuRoC: the cameras expose in turn", "no pair", "0 pairs; skipped: 6 pictures without a partner");
  make_lists({"0", "1403636579763555584", "1403636579813555584"}, {"0", "1403636579763555584", "1403636579813555584"});
  expect("EuRoC: a first stamp of 0", "endless ticks written", "cam0/data.csv:3: 1403636579.76");
  make_lists({"1403636579763555584", "1403723079763555584"}, {"1403636579763555584", "1403723079763555584"});
  expect("EuRoC: a stamp that jumps by a day", "endless ticks written", "cam0/data.csv:3: 86500.00");
  make_lists({"1403636579763555", "1403636579813555"}, {"1403636579763555", "1403636579813555"});
  expect("EuRoC: stamps in microseconds", "taken, a thousand times too fast",
         "cam0/data.csv: a picture every 0.000050 s");
  make_lists({"1403636579.763", "1403636579.813"}, {"1403636579.763", "1403636579.813"});
  expect("EuRoC: stamps in seconds (evo issue 329)", "'no time in nanoseconds'",
         "data.csv:2: '1403636579.763' is not a time in nano");
}

TEST_F(WildImport, EurocsTables) {
  make_lists({"1000000000", "1050000000"}, {"1000000000", "1050000000"});
  for (const char* camera : {"cam0", "cam1"})
    write_text(data_ / "mav0" / camera / "data.csv",
               "\xef\xbb\xbftimestamp, filename\r\n1000000000 , a.png \r\n\r\n1050000000,\tb.png\r\n");
  expect("EuRoC: blanks, CRLF, the mark of UTF-8, a head without #", "'no time', or pictures with a blank in the name",
         "2 pairs, from a.png");
  for (const char* camera : {"cam0", "cam1"})
    write_text(data_ / "mav0" / camera / "data.csv", "1000000000,a.png\n1050000000,b.png\n");
  expect("EuRoC: no head", "taken", "2 pairs");
  write_text(data_ / "mav0/cam1/data.csv", "1000000000,a.png\n1050000000\n");
  expect("EuRoC: a row without a name", "'too few columns'", "cam1/data.csv:2: no name of a picture");
  write_text(data_ / "mav0/cam1/data.csv", "1000000000,a.png\n1050000000,b.png\n1100000000,gone.png\n");
  write_text(data_ / "mav0/cam0/data.csv", "1000000000,a.png\n1050000000,b.png\n1100000000,c.png\n");
  expect("EuRoC: pictures of the list that are not there", "refused in the middle",
         "skipped: 1 pairs with a missing image file");
}

TEST_F(WildImport, EurocsTruth) {
  make_lists({"1000000000", "1050000000", "1100000000", "1150000000"},
             {"1000000000", "1050000000", "1100000000", "1150000000"});
  const char* before = "with the pose of another time";
  write_text(truth_file(),
             "#timestamp, p_x, p_y, p_z, q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
             "1050000000,1,2,3,1,0,0,0,\n1100000000,1,2,4,1,0,0,0,\n");
  expect("EuRoC: truth that begins later and ends earlier than the pictures", "27 % and 35 % of error",
         "3 pairs, from b.png");
  const StereoDataSet set = read_stereo_data_set(data_.string(), "", 10.0);
  EXPECT_EQ(set.pairs.front().since_first, 0);
  EXPECT_EQ(set.skipped.at("pairs before the ground truth begins"), 1);
  EXPECT_FALSE(set.pairs.back().T_map_body.has_value());
  EXPECT_NEAR(set.pairs.front().T_map_body->linear()(2, 2), 1.0, 1e-9) << "level at the first truth";
  expect("EuRoC: a comma at the end of each row (evo issue 159)", "taken", "from b.png");
  write_text(truth_file(), "1000000000,1,2,3,1,0,0,0\n1050000000,nan,nan,nan,1,0,0,0\n1100000000,1,2,4,1,0,0,0\n");
  expect("EuRoC: rows of NaN in the truth", "refused without a line",
         "skipped: 1 rows of the ground truth that are not a number");
  write_text(truth_file(), "1000000000,1,2,3,0.5,0,0,0\n");
  expect("EuRoC: a quaternion that is not of length one", "refused without a line",
         "data.csv:1: qw, qx, qy, qz are not a unit");
  write_text(truth_file(), "#t, x, y, z, qx, qy, qz, qw\n1000000000,1,2,3,0,0,0,1\n");
  expect("EuRoC: columns qx qy qz qw", before, "the columns time, x, y, z, qw, qx, qy, qz are expected");
  write_text(truth_file(), "1403636580,1,2,3,1,0,0,0\n1403636581,1,2,3,1,0,0,0\n");
  expect("EuRoC: truth in seconds, pictures in nanoseconds (evo issue 12)", "imported without truth",
         "no image is within the time of the ground truth");
}

TEST_F(WildImport, EurocsCameras) {
  make_lists({"1000000000", "1050000000"}, {"1000000000", "1050000000"});
  const auto replaced = [&](const char* camera, const std::string& from, const std::string& to) {
    make_lists({"1000000000", "1050000000"}, {"1000000000", "1050000000"});
    const fs::path file = data_ / "mav0" / camera / "sensor.yaml";
    std::ifstream in(file);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find(from), from.size(), to);
    write_text(file, text);
  };
  fs::rename(data_ / "mav0/cam0", data_ / "mav0/other");
  fs::rename(data_ / "mav0/cam1", data_ / "mav0/cam0");
  fs::rename(data_ / "mav0/other", data_ / "mav0/cam1");
  expect("EuRoC: cam0 and cam1 exchanged", "taken; no disparity anywhere",
         "cam1/sensor.yaml: T_BS: the second camera is not to the right");
  replaced("cam0", "radial-tangential", "equidistant");
  expect("EuRoC: one camera equidistant", "refused", "distortion_model: another one than that of cam0");
  replaced("cam0", "radial-tangential", "fov");
  expect("EuRoC: a model that is not supported", "refused", "the model 'fov' is not supported");
  replaced("cam0", "[64, 48]", "[128, 96]");
  replaced("cam1", "0.11,", "110,");
  expect("EuRoC: T_BS in millimetres", "taken", "T_BS: a baseline of 110 m");
}

TEST_F(WildImport, RefusesImagesOfWrongSize) {
  const auto import_says = [&] { return refusal(options()); };
  make_kitti();
  write_text(data_ / "calib.txt", "P0: 700 0 62 0 0 701 44 0 0 0 1 0\nP1: 700 0 62 -350 0 701 44 0 0 0 1 0\n");
  expect_said("KITTI: pictures of half the size of the calibration's", "taken", import_says(),
              "is it for another image size?");
  make_kitti();
  const fs::path cut = data_ / "image_1/000001.png";
  fs::resize_file(cut, fs::file_size(cut) - 20);
  expect_said("a PNG that is cut short", "refused in two lines", import_says(), "000001.png: ");
  make_kitti();
  for (const char* folder : {"image_0", "image_1"}) fs::remove(data_ / folder / "000001.png");
  for (const char* folder : {"image_0", "image_1"}) write_picture(data_ / folder / "000001.JPG", 7);
  fs::resize_file(data_ / "image_1/000001.JPG", fs::file_size(data_ / "image_1/000001.JPG") - 20);
  expect_said("a JPEG that is cut short", "taken, its lower half grey", import_says(),
              "000001.JPG: the image is truncated");
  for (const char* folder : {"image_0", "image_1"}) fs::remove(data_ / folder / "000001.JPG");
  make_kitti();
  write_text(data_ / "image_0/000001.png", "");
  expect_said("an empty picture", "refused", import_says(), "000001.png: empty");
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(WildImport, OutputIsCompleteOrAbsent) {
  make_kitti();
  ImportOptions asked = options();
  asked.out = data_.string();
  expect_said("import DATA --out DATA", "refused", refusal(asked), "already exists and is not empty");
  fs::create_directories(out_ / ".unfinished/config");
  write_text(out_ / ".unfinished/traverse.lcm", "of a try that was killed");
  const std::string last = import_data_set(options()).back();
  EXPECT_TRUE(fs::exists(out_ / "traverse.lcm"));
  EXPECT_FALSE(fs::exists(out_ / ".unfinished"));
  expect_said("import again after SIGKILL", "'.unfinished: cannot be made', for ever", last, "next: ./rover replay");
}

}  // namespace
}  // namespace rover::interchange
