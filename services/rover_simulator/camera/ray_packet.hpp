// Eight rays at a time: what Embree traces at once and what loops over fixed arrays let the compiler vectorise.
#pragma once

namespace rover {

inline constexpr int kPacket = 8;

template <class T>
struct alignas(32) Lanes {
  T lane[kPacket];
  T& operator[](int k) { return lane[k]; }
  const T& operator[](int k) const { return lane[k]; }
};

struct RayPacket {
  Lanes<float> dir_x, dir_y, dir_z;  // unit length, map axes
  Lanes<float> pixel_m_per_m;        // width of a pixel at 1 m
};

}  // namespace rover
