#include "tools/report/svg.hpp"

#include <fmt/format.h>

#include "tools/report/palette.hpp"

namespace rover::report {
namespace {

std::string points_text(const Points& points) {
  std::string text;
  for (const Eigen::Vector2d& p : points) text += number_text(p.x(), 1) + "," + number_text(p.y(), 1) + " ";
  return text;
}

const char* anchor_text(Anchor anchor) {
  if (anchor == Anchor::kStart) return "start";
  return anchor == Anchor::kMiddle ? "middle" : "end";
}

}  // namespace

std::string number_text(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = (word << 8) | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[(word >> (18 - 6 * k)) & 63u] : '=';
  }
  return text;
}

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::rect(double x, double y, double w, double h, const std::string& style, double radius) {
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"{}\" style=\"{}\"/>\n", number_text(x),
                       number_text(y), number_text(w), number_text(h), number_text(radius), style);
}

void Svg::line(double x1, double y1, double x2, double y2, const std::string& style) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" style=\"{}\"/>\n", number_text(x1),
                       number_text(y1), number_text(x2), number_text(y2), style);
}

void Svg::circle(double x, double y, double r, const std::string& style) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" style=\"{}\"/>\n", number_text(x), number_text(y),
                       number_text(r), style);
}

void Svg::polyline(const Points& points, const std::string& style) {
  body_ += fmt::format("<polyline points=\"{}\" style=\"fill:none;{}\"/>\n", points_text(points), style);
}

void Svg::polygon(const Points& points, const std::string& style) {
  body_ += fmt::format("<polygon points=\"{}\" style=\"{}\"/>\n", points_text(points), style);
}

void Svg::path(const std::string& data, const std::string& style) {
  body_ += fmt::format("<path d=\"{}\" style=\"{}\"/>\n", data, style);
}

void Svg::text(double x, double y, const std::string& text, double size, const std::string& style, Anchor anchor) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" style=\"font-size:{}px;{}\">{}</text>\n",
                       number_text(x), number_text(y), anchor_text(anchor), number_text(size), style, escaped(text));
}

void Svg::jpeg(double x, double y, double w, double h, const std::vector<std::uint8_t>& bytes) {
  body_ += fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "xlink:href=\"data:image/jpeg;base64,{}\"/>\n",
      number_text(x), number_text(y), number_text(w), number_text(h), base64(bytes));
}

void Svg::begin_clip(const std::string& id, double x, double y, double w, double h) {
  body_ += fmt::format("<clipPath id=\"{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n", id,
                       number_text(x), number_text(y), number_text(w), number_text(h));
  begin_group(fmt::format("clip-path=\"url(#{})\"", id));
}

void Svg::begin_group(const std::string& attributes) {
  body_ += "<g " + attributes + ">\n";
}

std::string Svg::str() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" style=\"font-family:{2};fill:{3}\">\n{4}</svg>\n",
      number_text(width_), number_text(height_), palette::kFont, palette::kInk, body_);
}

}  // namespace rover::report
