#include "tools/report/rasterise.hpp"

#include <cairo.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>

#include "common/bus/config.hpp"

namespace rover::report {
namespace {

template <class T, auto destroy>
struct Destroy {
  void operator()(T* object) const { destroy(object); }
};
using Stream = std::unique_ptr<GInputStream, Destroy<void, g_object_unref>>;
using Handle = std::unique_ptr<RsvgHandle, Destroy<void, g_object_unref>>;
using Surface = std::unique_ptr<cairo_surface_t, Destroy<cairo_surface_t, cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Destroy<cairo_t, cairo_destroy>>;

}  // namespace

void write_png(const std::string& svg, double scale, const std::string& file) {
  GError* error = nullptr;
  const Stream stream(g_memory_input_stream_new_from_data(svg.data(), static_cast<gssize>(svg.size()), nullptr));
  // Embedded images may exceed the parser's default attribute size.
  const Handle handle(
      rsvg_handle_new_from_stream_sync(stream.get(), nullptr, RSVG_HANDLE_FLAG_UNLIMITED, nullptr, &error));
  if (!handle) {
    const std::string why = error->message;
    g_clear_error(&error);
    throw ConfigError(file + ": " + why);
  }
  double width = 0.0;
  double height = 0.0;
  rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width, &height);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width * scale)),
                                                   static_cast<int>(std::lround(height * scale))));
  const Context context(cairo_create(surface.get()));
  cairo_scale(context.get(), scale, scale);
  const RsvgRectangle viewport{0.0, 0.0, width, height};
  const bool drawn = rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error);
  g_clear_error(&error);
  if (!drawn || cairo_surface_write_to_png(surface.get(), file.c_str()) != CAIRO_STATUS_SUCCESS)
    throw ConfigError(file + ": cannot be written");
}

}  // namespace rover::report
