// Atomic checkpoints of a service's state in the run's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rover {

// Writes beside the old one and renames, so that a reader finds the old or the new, never half. False where the disk
// does not take it (the old one then stays).
bool save_checkpoint(const std::string& run_dir, const std::string& name, const std::vector<std::uint8_t>& bytes);
// Empty where there is none, or where it is damaged (length or checksum).
std::optional<std::vector<std::uint8_t>> load_checkpoint(const std::string& run_dir, const std::string& name);

}  // namespace rover
