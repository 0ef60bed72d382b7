// Fine ground texture: layers of tileable noise at increasing scale.
//
// A layer covers two octaves and is faded out by pixel footprint before it aliases, so no mip maps are needed. Texture
// coordinates are affine in world coordinates, so a point has the same albedo in both cameras and all frames.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#ifdef __SSE4_1__
#include <smmintrin.h>
#endif

namespace rover {

// Four channels at once (GCC and Clang vector type).
using Float4 = float __attribute__((vector_size(16)));

// Tile of noise: tone (unit variance, in kUnit steps) and two relief slopes (joint unit variance).
class DetailTexture {
 public:
  static constexpr int kSize = 512;
  static constexpr float kUnit = 1.0F / 32.0F;  // value of one step; +-4 sigma fit into a byte
  // Centre wavelength of the noise in texels.
  static constexpr double kWavelengthTexels = 6.0;

  // `grains`: rounded bright and dark pebbles on finer noise, instead of plain Gaussian noise.
  DetailTexture(std::uint64_t seed, bool grains);

  // Bilinear, periodic. u, v in texels, above -kOffset.
  Float4 sample(float u, float v) const {
    const float u_shifted = u + kOffset;
    const float v_shifted = v + kOffset;
    const int iu = static_cast<int>(u_shifted);
    const int iv = static_cast<int>(v_shifted);
    const float fu = u_shifted - static_cast<float>(iu);
    const float fv = v_shifted - static_cast<float>(iv);
    const int u0 = iu & kMask;
    const int u1 = (iu + 1) & kMask;
    const std::int32_t* row0 = &texels_[static_cast<size_t>(iv & kMask) * kSize];
    const std::int32_t* row1 = &texels_[static_cast<size_t>((iv + 1) & kMask) * kSize];
    const Float4 a = widen(row0[u0]) + (widen(row0[u1]) - widen(row0[u0])) * fu;
    const Float4 b = widen(row1[u0]) + (widen(row1[u1]) - widen(row1[u0])) * fu;
    return (a + (b - a) * fv) * kUnit;
  }

 private:
  static constexpr int kMask = kSize - 1;
  static constexpr float kOffset =
      16384.0F;  // a multiple of kSize: makes coordinates positive, so that truncation floors
#ifdef __SSE4_1__
  // GCC 12 compiles the portable conversion to scalar code.
  static Float4 widen(std::int32_t texel) {
    return _mm_cvtepi32_ps(_mm_cvtepi8_epi32(_mm_cvtsi32_si128(texel)));
  }
#else
  using Byte4 = std::int8_t __attribute__((vector_size(4)));
  static Float4 widen(std::int32_t texel) {
    return __builtin_convertvector(std::bit_cast<Byte4>(texel), Float4);
  }
#endif

  std::vector<std::int32_t> texels_;  // four signed bytes each
};

// Texture coordinates = offset + axes * two map coordinates, chosen by surface normal (triplanar mapping).
struct DetailLayer {
  double texel_m = 0.0;
  Eigen::Matrix2d texels_per_m;
  Eigen::Vector2d offset;
  bool grains = false;
};

// Projection planes of the textures: map coordinates kPlaneAxes[plane].
inline constexpr int kPlanes = 3;
inline constexpr std::array<std::array<int, 2>, kPlanes> kPlaneAxes = {{{0, 1}, {1, 2}, {0, 2}}};

inline constexpr int kDetailLayers = 5;
// From this layer on (wavelength 0.3 m) the finest tiles bake the tone into the vertex albedo.
inline constexpr int kFirstBakedLayer = 3;

struct GroundTexture {
  DetailTexture noise;
  DetailTexture grains;
  std::array<DetailLayer, kDetailLayers> layers;

  explicit GroundTexture(std::uint64_t seed);
  const DetailTexture& of(const DetailLayer& layer) const { return layer.grains ? grains : noise; }
};

}  // namespace rover
