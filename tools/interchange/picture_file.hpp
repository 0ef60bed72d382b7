// Reads an image file.
#pragma once

#include <string>

#include "common/core/image.hpp"

namespace rover::interchange {

// Converted to grey, unrotated. Throws ConfigError if it is not an image, truncated or damaged.
GrayImage read_picture(const std::string& file);

}  // namespace rover::interchange
