// The run's orbital map, read on first use, with its cached images.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mission_control/ground_map.hpp"

namespace rover::mission {

// Thread-safe.
class RunMap {
 public:
  using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

  // `run_dir` contains orbital_map.tif; empty: no map.
  RunMap(std::string run_dir, const SlopeLimits& limits, double rover_length_m);

  // Null without a map.
  const GroundMap* get();
  // "relief" (JPEG), "slope" or "difficulty" (PNG); null without a map.
  Bytes picture(const std::string& name);

 private:
  void read();

  std::string run_dir_;
  SlopeLimits limits_;
  double rover_length_m_;
  std::once_flag read_;
  std::unique_ptr<GroundMap> map_;
  std::mutex mutex_;
  std::map<std::string, Bytes> pictures_;
};

}  // namespace rover::mission
