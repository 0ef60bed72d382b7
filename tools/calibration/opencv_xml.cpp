#include "tools/calibration/opencv_xml.hpp"

#include <glib.h>

#include <memory>
#include <set>
#include <sstream>
#include <vector>

#include "common/bus/config.hpp"

namespace rover::calibration {
namespace {

constexpr size_t kMaxLevels = 32;

struct Element {
  YAML::Node children;
  std::set<std::string> names;
  std::string text;
};

struct Tree {
  std::vector<Element> open{Element{}};  // the first element is the file
};

YAML::Node value_of(const Element& element) {
  if (element.children.size() > 0) return element.children;
  std::istringstream words(element.text);
  std::vector<std::string> values;
  for (std::string word; words >> word;) values.push_back(word);
  if (values.size() == 1) return YAML::Node(values.front());
  return YAML::Node(values);
}

void refuse(GError** error, const std::string& what) {
  g_set_error(error, G_MARKUP_ERROR, G_MARKUP_ERROR_INVALID_CONTENT, "%s", what.c_str());
}

void begin(GMarkupParseContext*, const char* name, const char**, const char**, void* tree, GError** error) {
  auto& open = static_cast<Tree*>(tree)->open;
  if (open.size() > kMaxLevels) refuse(error, "more than " + std::to_string(kMaxLevels) + " levels deep");
  if (std::string(name) != "_" && !open.back().names.insert(name).second)
    refuse(error, std::string(name) + ": given twice");
  open.emplace_back();
}

void end(GMarkupParseContext*, const char* name, void* tree, GError** error) {
  auto& open = static_cast<Tree*>(tree)->open;
  const YAML::Node value = value_of(open.back());
  open.pop_back();
  YAML::Node& parent = open.back().children;
  const bool item = std::string(name) == "_";
  if (parent.IsNull() || parent.IsSequence() == item) {
    item ? parent.push_back(value) : parent.force_insert(std::string(name), value);
  } else {
    refuse(error, std::string(name) + ": items of a list beside keys");
  }
}

void add_text(GMarkupParseContext*, const char* text, gsize length, void* tree, GError**) {
  static_cast<Tree*>(tree)->open.back().text.append(text, length);
}

}  // namespace

YAML::Node parse_opencv_xml(const std::string& text, const std::string& name) {
  constexpr GMarkupParser kParser{begin, end, add_text, nullptr, nullptr};
  Tree tree;
  const std::unique_ptr<GMarkupParseContext, void (*)(GMarkupParseContext*)> context(
      g_markup_parse_context_new(&kParser, GMarkupParseFlags{}, &tree, nullptr), g_markup_parse_context_free);
  GError* error = nullptr;
  if (g_markup_parse_context_parse(context.get(), text.data(), static_cast<gssize>(text.size()), &error) == 0 ||
      g_markup_parse_context_end_parse(context.get(), &error) == 0) {
    const std::unique_ptr<GError, void (*)(GError*)> owner(error, g_error_free);
    int line = 0;
    g_markup_parse_context_get_position(context.get(), &line, nullptr);
    throw ConfigError(name + ":" + std::to_string(line) + ": not valid XML: " + error->message);
  }
  const YAML::Node& root = tree.open.front().children;
  if (!root.IsMap() || !root["opencv_storage"]) throw ConfigError(name + ": not XML as OpenCV writes it");
  return root["opencv_storage"];
}

}  // namespace rover::calibration
