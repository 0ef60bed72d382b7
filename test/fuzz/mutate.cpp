#include "mutate.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <random>

namespace rover::fuzz {
namespace {

constexpr size_t kMostBytes = 1 << 21;

const std::vector<std::string> kNumbers = {"0",
                                           "-0",
                                           "-1",
                                           "1e308",
                                           "-1e308",
                                           "1e-320",
                                           "nan",
                                           "inf",
                                           "-inf",
                                           "1e999",
                                           "012",
                                           "0x7fffffff",
                                           "2147483647",
                                           "2147483648",
                                           "-2147483649",
                                           "4294967296",
                                           "9223372036854775807",
                                           "9223372036854775808",
                                           "-9223372036854775808",
                                           "18446744073709551616",
                                           "99999999999999999999999999",
                                           "1.",
                                           ".5",
                                           "1,5",
                                           "1_000",
                                           "1e",
                                           "",
                                           "0.00000000000000000000000000001",
                                           "3600000000",
                                           "1403636579763555584"};

class Editor {
 public:
  Editor(std::string& bytes, std::mt19937_64& random) : bytes_(bytes), random_(random) {}

  // Below `limit`, which is at least 1.
  size_t below(size_t limit) { return static_cast<size_t>(random_() % limit); }
  template <class T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }
  size_t place() { return below(bytes_.size() + 1); }

  void change_bytes() {
    for (size_t i = 0, count = 1 + below(4); i < count && !bytes_.empty(); ++i)
      bytes_[below(bytes_.size())] = static_cast<char>(below(256));
  }
  void flip_bit() {
    if (!bytes_.empty()) bytes_[below(bytes_.size())] ^= static_cast<char>(1U << below(8));
  }
  void cut_out() {
    const size_t begin = place();
    bytes_.erase(begin, below(1 + std::min<size_t>(bytes_.size() - begin, 200)));
  }
  void cut_off() { bytes_.resize(place()); }
  void repeat() {
    const size_t begin = place();
    const std::string part = bytes_.substr(begin, 1 + below(100));
    const size_t most = 1 + (part.empty() ? 0 : std::min<size_t>(20'000 / part.size(), 1000));
    std::string many;
    for (size_t i = 0, count = 1 + below(most); i < count; ++i) many += part;
    bytes_.insert(begin, many);
  }
  void insert(const std::string& text) { bytes_.insert(place(), text); }

  // A field of a binary header, in either byte order.
  void set_field() {
    constexpr std::array<std::uint64_t, 10> kValues = {0,          1,          0x7fff,     0xffff,     0x7fffffff,
                                                       0x80000000, 0xffffffff, 0x10000000, 1ULL << 40, ~0ULL};
    const size_t length = size_t{1} << below(4);
    if (bytes_.size() < length) return;
    const std::uint64_t value = kValues[below(kValues.size())] + below(3) - 1;
    const size_t at = below(bytes_.size() - length + 1);
    const bool big = below(2) == 0;
    for (size_t i = 0; i < length; ++i) bytes_[at + i] = static_cast<char>(value >> (8 * (big ? length - 1 - i : i)));
  }

  void change_number() {
    const auto in_number = [&](size_t i) {
      const auto c = static_cast<unsigned char>(bytes_[i]);
      return std::isdigit(c) != 0 || c == '.' || c == '-' || c == '+';
    };
    size_t begin = place();
    while (begin < bytes_.size() && std::isdigit(static_cast<unsigned char>(bytes_[begin])) == 0) ++begin;
    if (begin == bytes_.size()) return;
    size_t end = begin;
    while (begin > 0 && in_number(begin - 1)) --begin;
    while (end < bytes_.size() && in_number(end)) ++end;
    bytes_.replace(begin, end - begin, one_of(kNumbers));
  }

  void change_lines() {
    std::vector<std::string> lines;
    for (size_t at = 0; at < bytes_.size();) {
      const size_t end = std::min(bytes_.find('\n', at), bytes_.size() - 1) + 1;
      lines.push_back(bytes_.substr(at, end - at));
      at = end;
    }
    if (lines.empty()) return;
    const size_t line = below(lines.size()), other = below(lines.size());
    switch (below(4)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(line));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(other), lines[line]);
        break;
      case 2:
        std::swap(lines[line], lines[other]);
        break;
      default:
        lines[line] = std::string(1 + below(4), ' ') + lines[line];
    }
    bytes_.clear();
    for (const std::string& each : lines) bytes_ += each;
  }

  void splice(const std::string& other) {
    bytes_.resize(place());
    bytes_ += other.substr(below(other.size() + 1));
  }

 private:
  std::string& bytes_;
  std::mt19937_64& random_;
};

}  // namespace

Input mutated(const std::vector<Input>& corpus, const std::vector<std::string>& words, std::uint64_t seed,
              std::uint64_t number) {
  std::mt19937_64 random(seed * 0x9e3779b97f4a7c15ULL + number);
  Input input = corpus[random() % corpus.size()];
  Editor editor(input.bytes, random);
  for (size_t i = 0, count = 1 + editor.below(6); i < count; ++i) {
    switch (editor.below(12)) {
      case 0:
        editor.change_bytes();
        break;
      case 1:
        editor.flip_bit();
        break;
      case 2:
        editor.cut_out();
        break;
      case 3:
        if (editor.below(4) == 0) editor.cut_off();
        break;
      case 4:
        editor.repeat();
        break;
      case 5:
        editor.set_field();
        break;
      case 6:
        editor.splice(editor.one_of(corpus).bytes);
        break;
      case 7:
        editor.change_lines();
        break;
      case 8:
        if (!words.empty()) editor.insert(editor.one_of(words));
        break;
      default:
        editor.change_number();
    }
    if (input.bytes.size() > kMostBytes) input.bytes.resize(kMostBytes);
  }
  return input;
}

}  // namespace rover::fuzz
