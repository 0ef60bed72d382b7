// Messages in Foxglove's JSON schemas for images and frames (https://docs.foxglove.dev/docs/sdk/schemas).
#pragma once

#include <rover/disparity_t.hpp>
#include <rover/image_t.hpp>
#include <rover/pose_t.hpp>
#include <string>

namespace rover::interchange::foxglove {

inline constexpr char kCompressedImage[] = "foxglove.CompressedImage";
inline constexpr char kRawImage[] = "foxglove.RawImage";
inline constexpr char kFrameTransforms[] = "foxglove.FrameTransforms";

// JSON schema of one of the three above.
std::string schema(const std::string& name);

// Empty if the message is inconsistent.
std::string compressed_image(const image_t& message, const std::string& frame);  // PNG
std::string raw_image(const disparity_t& message, const std::string& frame);     // 16 bit, 0: invalid
// map -> odom -> body; empty if not yet known.
std::string frame_transforms(const pose_t& message);

}  // namespace rover::interchange::foxglove
