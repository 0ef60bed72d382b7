#include "rover_simulator/camera/ground_shader.hpp"

#include <algorithm>
#include <cmath>

// Disabled under ThreadSanitizer: the ifunc resolver would run before the sanitizer is loaded.
#if defined(__SANITIZE_THREAD__) || !defined(__x86_64__)
#define ROVER_AVX2_CLONE
#else
#define ROVER_AVX2_CLONE [[gnu::target_clones("avx2", "default")]]
#endif

namespace rover {
namespace {

constexpr float kFineWavelength_m = 0.05F;
// Half width of the penumbra as tangent of elevation: the sun's disc (0.003) plus scattering.
constexpr float kPenumbra = 0.012F;
// A layer has full contrast from five samples per centre wavelength and fades to zero at two: it covers two octaves.
constexpr float kSamplesGone = 2.0F;
constexpr float kSamplesFull = 5.0F;
// An oblique pixel's footprint is sampled along its length (anisotropic filtering), because a single sample aliases
// there, differently in the two images of a pair. Beyond this many samples the texture is blurred in both directions.
constexpr float kMaxSamples = 4.0F;
constexpr float kMinFacing = 0.04F;       // cosine of the angle between ray and normal
constexpr float kMinSineSquared = 0.04F;  // of the same angle: a pixel that looks straight down has no long side

float smooth_step(float t) {
  t = std::min(std::max(t, 0.0F), 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

}  // namespace

// Intermediate shading state of eight points.
struct GroundShader::State {
  Lanes<float> slope_x, slope_y, sun_margin, albedo;
  Lanes<float> fine_contrast, coarse_contrast, bump;
  Lanes<float> normal_x, normal_y, normal_z;
  Lanes<float> unbaked;    // 0 where long wavelengths are baked into the vertices
  Lanes<int> samples;      // along the pixel's footprint
  Lanes<float> spacing_m;  // of the samples
  Lanes<int> plane;        // projection plane of the textures, and the point's coordinates in it
  Lanes<float> a, b;
  Lanes<float> step_a, step_b;  // from one sample to the next, in the plane
  Lanes<float> tone;
};

namespace {

// Bilinear interpolation, clamped to the tile.
template <class State>
[[gnu::always_inline]] inline void interpolate(const GroundTile& tile, float x, float y, int k, State& at) {
  const TileLevel& level = kLevels[tile.key().level];
  const auto cells_per_m = static_cast<float>(1.0 / level.spacing_m);
  const float limit = static_cast<float>(level.cells) - 0.001F;
  const float gx = std::min(std::max(x * cells_per_m, 0.0F), limit);
  const float gy = std::min(std::max(y * cells_per_m, 0.0F), limit);
  const int i = static_cast<int>(gx);
  const int j = static_cast<int>(gy);
  const float fx = gx - static_cast<float>(i);
  const float fy = gy - static_cast<float>(j);
  const Float4* a = &tile.vertices()[static_cast<size_t>(j) * (level.cells + 1) + i].surface;
  const Float4* b = a + 2 * (level.cells + 1);
  const auto blend = [&](int n) {
    const Float4 low = a[n] + (a[n + 2] - a[n]) * fx;
    const Float4 high = b[n] + (b[n + 2] - b[n]) * fx;
    return low + (high - low) * fy;
  };
  const Float4 surface = blend(0);
  const Float4 appearance = blend(1);
  at.unbaked[k] = tile.baked() ? 0.0F : 1.0F;
  at.slope_x[k] = surface[0];
  at.slope_y[k] = surface[1];
  at.sun_margin[k] = surface[2];
  at.albedo[k] = appearance[0];
  at.fine_contrast[k] = appearance[1];
  at.coarse_contrast[k] = appearance[2];
  at.bump[k] = appearance[3];
}

}  // namespace

GroundShader::GroundShader(const GroundAppearanceConfig& config, const GroundTexture& texture)
    : sun_x_(static_cast<float>(std::cos(config.sun_elevation_rad) * std::cos(config.sun_azimuth_rad))),
      sun_y_(static_cast<float>(std::cos(config.sun_elevation_rad) * std::sin(config.sun_azimuth_rad))),
      sun_z_(static_cast<float>(std::sin(config.sun_elevation_rad))),
      sky_light_(static_cast<float>(config.sky_light)) {
  for (int k = 0; k < kDetailLayers; ++k) {
    const DetailLayer& from = texture.layers[k];
    const auto texels_per_m = static_cast<float>(1.0 / from.texel_m);
    const Eigen::Matrix2f rotation = (from.texels_per_m * from.texel_m).cast<float>();
    const auto wavelength_m = static_cast<float>(DetailTexture::kWavelengthTexels * from.texel_m);
    layers_[k] = {&texture.of(from), rotation(0, 0), rotation(0, 1),
                  texels_per_m,      wavelength_m,   wavelength_m < kFineWavelength_m};
  }
}

void GroundShader::face(const RayPacket& rays, const Points& points, State& at) const {
  for (int k = 0; k < kPacket; ++k) {
    const float sx = at.slope_x[k];
    const float sy = at.slope_y[k];
    const float scale = 1.0F / std::sqrt(1.0F + sx * sx + sy * sy);
    at.normal_x[k] = -sx * scale;
    at.normal_y[k] = -sy * scale;
    at.normal_z[k] = scale;
    const float facing = std::max((sx * rays.dir_x[k] + sy * rays.dir_y[k] - rays.dir_z[k]) * scale, kMinFacing);
    const float samples = std::min(std::ceil(1.0F / facing), kMaxSamples);
    at.samples[k] = static_cast<int>(samples);
    at.spacing_m[k] = points.pixel_m[k] / (facing * samples);
    at.tone[k] = 1.0F;
    const bool steep = sx * sx + sy * sy > 1.0F;
    const bool faces_x = sx * sx > sy * sy;
    at.plane[k] = steep ? (faces_x ? 1 : 2) : 0;
    at.a[k] = steep && faces_x ? points.y[k] : points.x[k];
    at.b[k] = steep ? points.z[k] : points.y[k];
    // The footprint lies along the ray, projected on the surface.
    const float stretch = at.spacing_m[k] / std::sqrt(std::max(1.0F - facing * facing, kMinSineSquared));
    const float along_x = (rays.dir_x[k] + facing * at.normal_x[k]) * stretch;
    const float along_y = (rays.dir_y[k] + facing * at.normal_y[k]) * stretch;
    const float along_z = (rays.dir_z[k] + facing * at.normal_z[k]) * stretch;
    at.step_a[k] = steep && faces_x ? along_y : along_x;
    at.step_b[k] = steep ? along_z : along_y;
  }
}

void GroundShader::add_layer(int index, const Points& points, State& at) const {
  const Layer& layer = layers_[index];
  Lanes<float> weight;
  float sum = 0.0F;
  for (int k = 0; k < kPacket; ++k) {
    constexpr float kSlope = 1.0F / (kSamplesFull - kSamplesGone);
    weight[k] = smooth_step((layer.wavelength_m / at.spacing_m[k] - kSamplesGone) * kSlope);
    if (index >= kFirstBakedLayer) weight[k] *= at.unbaked[k];
  }
  for (int k = 0; k < kPacket; ++k) sum += weight[k];
  if (sum <= 0.0F) return;

  Lanes<float> u, v, step_u, step_v;
  for (int k = 0; k < kPacket; ++k) {
    u[k] = layer.texels_per_m * (layer.cosine * at.a[k] + layer.sine * at.b[k]);
    v[k] = layer.texels_per_m * (layer.cosine * at.b[k] - layer.sine * at.a[k]);
    step_u[k] = layer.texels_per_m * (layer.cosine * at.step_a[k] + layer.sine * at.step_b[k]);
    step_v[k] = layer.texels_per_m * (layer.cosine * at.step_b[k] - layer.sine * at.step_a[k]);
  }
  Lanes<float> tone{}, slope_u{}, slope_v{};
  for (int k = 0; k < kPacket; ++k) {
    if (points.tile[k] == nullptr) continue;
    const Eigen::Vector2f& origin = points.tile[k]->texture_origin(index, at.plane[k]);
    // Waves much longer than the footprint need one sample only.
    const auto length = static_cast<float>(at.samples[k]);
    const int samples = layer.wavelength_m > kSamplesFull * length * at.spacing_m[k] ? 1 : at.samples[k];
    const float first = -0.5F * static_cast<float>(samples - 1);
    Float4 detail{};
    for (int i = 0; i < samples; ++i) {
      const float t = first + static_cast<float>(i);
      detail += layer.texture->sample(origin.x() + u[k] + t * step_u[k], origin.y() + v[k] + t * step_v[k]);
    }
    detail = detail / static_cast<float>(samples);
    tone[k] = detail[0];
    slope_u[k] = detail[1];
    slope_v[k] = detail[2];
  }
  const Lanes<float>& contrast = layer.fine ? at.fine_contrast : at.coarse_contrast;
  for (int k = 0; k < kPacket; ++k) {
    const float bump = weight[k] * at.bump[k];
    const float bump_a = bump * (layer.cosine * slope_u[k] - layer.sine * slope_v[k]);
    const float bump_b = bump * (layer.sine * slope_u[k] + layer.cosine * slope_v[k]);
    at.tone[k] += weight[k] * contrast[k] * tone[k];
    at.normal_x[k] -= at.plane[k] != 1 ? bump_a : 0.0F;
    at.normal_y[k] -= at.plane[k] == 0 ? bump_b : at.plane[k] == 1 ? bump_a : 0.0F;
    at.normal_z[k] -= at.plane[k] != 0 ? bump_b : 0.0F;
  }
}

// Eight lanes fill an AVX2 register. Neither clone fuses or reorders operations, so both are byte-identical.
ROVER_AVX2_CLONE Lanes<float> GroundShader::radiance(const RayPacket& rays, const Points& points) const {
  State at{};
  for (int k = 0; k < kPacket; ++k)
    if (points.tile[k] != nullptr) interpolate(*points.tile[k], points.x[k], points.y[k], k, at);

  face(rays, points, at);
  for (int layer = 0; layer < kDetailLayers; ++layer) add_layer(layer, points, at);

  Lanes<float> radiance;
  for (int k = 0; k < kPacket; ++k) {
    const float nx = at.normal_x[k];
    const float ny = at.normal_y[k];
    const float nz = at.normal_z[k];
    const float scale = 1.0F / std::sqrt(nx * nx + ny * ny + nz * nz);
    const float lambert = std::max((nx * sun_x_ + ny * sun_y_ + nz * sun_z_) * scale, 0.0F);
    const float lit = smooth_step(at.sun_margin[k] * (0.5F / kPenumbra) + 0.5F);
    const float light = lit * lambert + sky_light_ * (0.5F + 0.5F * nz * scale);
    radiance[k] = at.albedo[k] * std::max(at.tone[k], 0.25F) * light;
  }
  for (int k = 0; k < kPacket; ++k) {
    // Dusty sky, brighter towards the horizon, about as bright as the ground.
    if (points.tile[k] == nullptr) radiance[k] = sky_light_ * (0.9F - 0.4F * std::max(rays.dir_z[k], 0.0F));
  }
  return radiance;
}

}  // namespace rover
