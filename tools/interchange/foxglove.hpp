// What Foxglove draws by itself: pictures and frames, in its own JSON schemas
// (https://docs.foxglove.dev/docs/sdk/schemas).
#pragma once

#include <rover/disparity_t.hpp>
#include <rover/image_t.hpp>
#include <rover/pose_t.hpp>
#include <string>

namespace rover::interchange::foxglove {

inline constexpr char kCompressedImage[] = "foxglove.CompressedImage";
inline constexpr char kRawImage[] = "foxglove.RawImage";
inline constexpr char kFrameTransforms[] = "foxglove.FrameTransforms";

// The JSON schema of one of the three above.
std::string schema(const std::string& name);

// Empty where the message contradicts itself.
std::string compressed_image(const image_t& message, const std::string& frame);  // PNG
std::string raw_image(const disparity_t& message, const std::string& frame);     // 16 bit, 0: none
// map -> odom -> body; empty where it is not known yet.
std::string frame_transforms(const pose_t& message);

}  // namespace rover::interchange::foxglove
