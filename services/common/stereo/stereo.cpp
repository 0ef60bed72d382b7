#include "common/stereo/stereo.hpp"

#include <utility>

namespace rover::stereo {
namespace {

bool has_rig_size(const GrayImage& image, const StereoCamera& camera) {
  return image.width == camera.width && image.height == camera.height &&
         image.data.size() == static_cast<size_t>(camera.width) * camera.height;
}

}  // namespace

Stereo::Stereo(const StereoConfig& config, const StereoRig& rig, double origin_height_m)
    : rectifier_(rig, BlockMatcher::pad(config.matcher),
                 config.ground_reference ? std::optional<double>(origin_height_m) : std::nullopt),
      matcher_(config.matcher) {}

std::optional<StereoResult> Stereo::step(const GrayImage& left, const GrayImage& right) {
  if (!has_rig_size(left, camera()) || !has_rig_size(right, camera())) return std::nullopt;
  RectifiedPair pair = rectifier_.rectify(left, right);
  Disparity disparity = matcher_.match(pair, rectifier_);
  return StereoResult{std::move(pair.left), std::move(pair.right), std::move(disparity)};
}

}  // namespace rover::stereo
