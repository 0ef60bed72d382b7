// Serialisation of numbers, for checkpoints.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace rover {

class StateWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), begin, begin + sizeof(T));
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

class StateReader {
 public:
  explicit StateReader(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  // Value-initialised past the end; finished() is false then.
  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    if (!ok_ || bytes_.size() - next_ < sizeof(T)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data() + next_, sizeof(T));
    next_ += sizeof(T);
    return value;
  }
  // A count of items of at least `each` bytes, limited by the remaining bytes.
  size_t count(size_t each) {
    const auto n = get<std::uint64_t>();
    if (ok_ && n > (bytes_.size() - next_) / each) ok_ = false;
    return ok_ ? static_cast<size_t>(n) : 0;
  }
  bool finished() const { return ok_ && next_ == bytes_.size(); }

 private:
  const std::vector<std::uint8_t>& bytes_;
  size_t next_ = 0;
  bool ok_ = true;
};

}  // namespace rover
