// A picture from a file.
#pragma once

#include <string>

#include "common/core/image.hpp"

namespace rover::interchange {

// Grey, or turned grey; as it lies in the file. Throws ConfigError where it is none, is cut short or damaged.
GrayImage read_picture(const std::string& file);

}  // namespace rover::interchange
