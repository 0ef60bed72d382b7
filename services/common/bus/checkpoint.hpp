// Atomic checkpoints of a service's state in the run's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rover {

// Writes a new file and renames it, so a reader never finds a partial one. False if the disk refuses; the old one
// remains.
bool save_checkpoint(const std::string& run_dir, const std::string& name, const std::vector<std::uint8_t>& bytes);
bool checkpoint_exists(const std::string& run_dir, const std::string& name);
// Empty if absent or damaged (length or checksum).
std::optional<std::vector<std::uint8_t>> load_checkpoint(const std::string& run_dir, const std::string& name);

}  // namespace rover
