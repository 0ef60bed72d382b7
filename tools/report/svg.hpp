// Writes SVG. Lengths in user units (CSS pixels); inline styles keep a picture self-contained.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/report/polyline.hpp"

namespace rover::report {

// Shortest text of a number with at most this many decimals.
std::string number_text(double value, int decimals = 2);
std::string escaped(const std::string& text);
std::string base64(const std::vector<std::uint8_t>& bytes);

enum class Anchor { kStart, kMiddle, kEnd };

class Svg {
 public:
  Svg(double width, double height);

  void rect(double x, double y, double w, double h, const std::string& style, double radius = 0.0);
  void line(double x1, double y1, double x2, double y2, const std::string& style);
  void circle(double x, double y, double r, const std::string& style);
  void polyline(const Points& points, const std::string& style);
  void polygon(const Points& points, const std::string& style);
  // `data` as in an SVG path's d.
  void path(const std::string& data, const std::string& style);
  void text(double x, double y, const std::string& text, double size, const std::string& style,
            Anchor anchor = Anchor::kStart);
  void jpeg(double x, double y, double w, double h, const std::vector<std::uint8_t>& bytes);
  // Clips all drawing until end() to the rectangle. The id must be unique in the document.
  void begin_clip(const std::string& id, double x, double y, double w, double h);
  void begin_group(const std::string& attributes);
  void end() { body_ += "</g>\n"; }

  std::string str() const;

 private:
  double width_;
  double height_;
  std::string body_;
};

}  // namespace rover::report
