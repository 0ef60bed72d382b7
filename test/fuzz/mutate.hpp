// Makes wrong files out of right ones, as people and transfers do: the same input for the same corpus, seed and number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover::fuzz {

struct Input {
  std::string name;  // of the file of the corpus that it was made of
  std::string bytes;
};

// `words`: what the format gives a meaning to. The corpus must not be empty.
Input mutated(const std::vector<Input>& corpus, const std::vector<std::string>& words, std::uint64_t seed,
              std::uint64_t number);

}  // namespace rover::fuzz
