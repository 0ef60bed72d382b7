// Packets of eight rays, for Embree and for vectorised loops.
#pragma once

namespace rover {

inline constexpr int kPacket = 8;

template <class T>
struct alignas(32) Lanes {
  T lane[kPacket];
  T& operator[](int k) { return lane[k]; }
  const T& operator[](int k) const { return lane[k]; }
};

// Viewing rays in map axes.
struct RayPacket {
  Lanes<float> dir_x, dir_y, dir_z;  // unit length
  Lanes<float> cosine;               // of the angle to the optical axis: depth = range x cosine
};

inline constexpr int kNoTile = -1;

struct HitPacket {
  Lanes<int> tile;                            // index in the scene; kNoTile: no hit
  Lanes<float> range_m;                       // infinite without a hit
  Lanes<float> normal_x, normal_y, normal_z;  // of the mesh, not normalised
};

}  // namespace rover
