#include "tools/interchange/picture_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"

namespace rover::interchange {
namespace {

constexpr size_t kMaxPictureBytes = 64 << 20;

// Suppresses warnings of the PNG and JPEG libraries on stderr.
class SuppressStderr {
 public:
  SuppressStderr() : stderr_(dup(STDERR_FILENO)), nowhere_(open("/dev/null", O_WRONLY | O_CLOEXEC)) {
    dup2(nowhere_, STDERR_FILENO);
  }
  ~SuppressStderr() {
    dup2(stderr_, STDERR_FILENO);
    close(stderr_);
    close(nowhere_);
  }
  SuppressStderr(const SuppressStderr&) = delete;
  SuppressStderr& operator=(const SuppressStderr&) = delete;

 private:
  int stderr_;
  int nowhere_;
};

// Decoders accept truncated files: check the end marker (PNG: IEND, JPEG: ff d9); trailing bytes are allowed.
bool is_whole(const std::string& bytes) {
  const bool png = bytes.starts_with("\x89PNG");
  return bytes.find(png ? "IEND" : "\xff\xd9", bytes.size() - std::min<size_t>(bytes.size(), 1024)) !=
         std::string::npos;
}

cv::Mat decode(const std::string& bytes) {
  const SuppressStderr suppressed;
  const cv::Mat view(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
  try {
    return cv::imdecode(view, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

GrayImage read_picture(const std::string& file) {
  const std::string bytes = read_text(file, kMaxPictureBytes);
  if (bytes.empty()) throw ConfigError(file + ": empty file");
  const cv::Mat picture = decode(bytes);
  if (picture.empty()) throw ConfigError(file + ": not a readable image");
  if (!is_whole(bytes)) throw ConfigError(file + ": the image is truncated");
  GrayImage image(picture.cols, picture.rows);
  picture.copyTo(cv::Mat(picture.rows, picture.cols, CV_8UC1, image.data.data()));
  return image;
}

}  // namespace rover::interchange
