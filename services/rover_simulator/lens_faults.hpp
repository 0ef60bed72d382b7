// What a damaged, dirty or displaced camera makes of an image.
#pragma once

#include "common/core/image.hpp"

namespace rover {

struct CameraFault {
  bool blind = false;
  bool frozen = false;
  // A knock: a turn of the camera by 0.5 deg moves its images by 3.6 px (LocCam), or rolls them about their centre.
  int shift_rows = 0;  // downwards; the border is replicated
  int shift_columns = 0;
  double roll_deg = 0.0;
  double fog = 0.0;    // 0 to 1: less contrast, more blur
  double dirt = 0.0;   // fraction of the image under dark spots, always the same ones
  double glare = 0.0;  // the sun in the upper part of the image: radius as a fraction of its width

  bool operator==(const CameraFault&) const = default;
};

GrayImage seen_with(const CameraFault& fault, GrayImage image);

}  // namespace rover
