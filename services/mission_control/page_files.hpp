// The files of the page, built into the program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rover::mission {

struct PageFile {
  std::string path;  // request path
  std::string type;
  std::string_view content;
};

const std::vector<PageFile>& page_files();

// Files of Debian's libjs-leaflet and libjs-chart.js, on disk.
struct LibraryFile {
  std::string path;
  std::string type;
  std::string file;
};
const std::vector<LibraryFile>& library_files();

}  // namespace rover::mission
