// SVG to PNG, through librsvg.
#pragma once

#include <string>

namespace rover::report {

// Throws ConfigError if the SVG is invalid or the file cannot be written.
void write_png(const std::string& svg, double scale, const std::string& file);

}  // namespace rover::report
