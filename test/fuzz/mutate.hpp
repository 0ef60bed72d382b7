// Mutates valid files, reproducibly for the same corpus, seed and number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover::fuzz {

struct Input {
  std::string name;  // of the original file in the corpus
  std::string bytes;
};

// `words`: tokens of the format. The corpus must not be empty.
Input mutated(const std::vector<Input>& corpus, const std::vector<std::string>& words, std::uint64_t seed,
              std::uint64_t number);

}  // namespace rover::fuzz
