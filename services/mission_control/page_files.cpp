#include "mission_control/page_files.hpp"

// Embeds each file with the assembler's .incbin. ROVER_PAGE_DIR: services/mission_control/page.
#define PAGE_FILE(name, file)                                                                       \
  __asm__(".pushsection .rodata\n" #name "_begin:\n.incbin \"" ROVER_PAGE_DIR "/" file "\"\n" #name \
          "_end:\n.byte 0\n.popsection\n");                                                         \
  extern "C" const char name##_begin[];                                                             \
  extern "C" const char name##_end[]

PAGE_FILE(page_index, "index.html");
PAGE_FILE(page_style, "style.css");
PAGE_FILE(page_app, "app.js");
PAGE_FILE(page_map, "map.js");
PAGE_FILE(page_panels, "panels.js");
PAGE_FILE(page_charts, "charts.js");
PAGE_FILE(page_camera, "camera.js");
PAGE_FILE(page_commands, "commands.js");
PAGE_FILE(page_icon, "icon.svg");

namespace rover::mission {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<size_t>(end - begin)};
}

}  // namespace

const std::vector<PageFile>& page_files() {
  static const std::vector<PageFile> kFiles = {
      {"/", "text/html; charset=utf-8", between(page_index_begin, page_index_end)},
      {"/style.css", "text/css", between(page_style_begin, page_style_end)},
      {"/app.js", "text/javascript", between(page_app_begin, page_app_end)},
      {"/map.js", "text/javascript", between(page_map_begin, page_map_end)},
      {"/panels.js", "text/javascript", between(page_panels_begin, page_panels_end)},
      {"/charts.js", "text/javascript", between(page_charts_begin, page_charts_end)},
      {"/camera.js", "text/javascript", between(page_camera_begin, page_camera_end)},
      {"/commands.js", "text/javascript", between(page_commands_begin, page_commands_end)},
      {"/icon.svg", "image/svg+xml", between(page_icon_begin, page_icon_end)},
  };
  return kFiles;
}

const std::vector<LibraryFile>& library_files() {
  static const std::string kRoot = "/usr/share/javascript";
  static const std::vector<LibraryFile> kFiles = {
      {"/leaflet.js", "text/javascript", kRoot + "/leaflet/leaflet.min.js"},
      {"/leaflet.css", "text/css", kRoot + "/leaflet/leaflet.css"},
      {"/chart.js", "text/javascript", kRoot + "/chart.js/chart.min.js"},
  };
  return kFiles;
}

}  // namespace rover::mission
