#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "renderer/core/scene_error.h"

namespace lacuna {

/// Reads an encoded image in memory from front to back, never beyond its end: every function throws
/// SceneError, with the image's label, if the image ends early.
class CheckedBytes {
 public:
  CheckedBytes(std::span<const std::uint8_t> bytes, const std::string& label)
      : all_(bytes), label_(label) {}

  std::size_t at() const { return at_; }
  bool empty() const { return at_ == all_.size(); }
  /// The next `n` bytes.
  std::span<const std::uint8_t> take(std::size_t n) {
    if (n > all_.size() - at_) fail("is corrupt: it ends early");
    at_ += n;
    return all_.subspan(at_ - n, n);
  }
  std::uint8_t byte() { return take(1)[0]; }
  /// An integer of up to 4 bytes, most significant byte first.
  std::uint32_t big_endian(std::size_t bytes) {
    std::uint32_t value = 0;
    for (const std::uint8_t b : take(bytes)) value = value << 8 | b;
    return value;
  }
  /// The same, least significant byte first.
  std::uint32_t little_endian(std::size_t bytes) {
    std::uint32_t value = 0;
    const auto taken = take(bytes);
    for (std::size_t i = bytes; i > 0; --i) value = value << 8 | taken[i - 1];
    return value;
  }
  /// The bytes from offset `begin` to the current one.
  std::span<const std::uint8_t> since(std::size_t begin) const {
    return all_.subspan(begin, at_ - begin);
  }
  [[noreturn]] void fail(const std::string& what) const { throw SceneError(label_ + ": " + what); }
  /// Fails unless 1 <= width, height <= max_side; `unit`: "pixels" or "texels".
  void require_size(std::int64_t width, std::int64_t height, int max_side,
                    const std::string& unit) const {
    if (width >= 1 && height >= 1 && width <= max_side && height <= max_side) return;
    fail("is " + std::to_string(width) + " x " + std::to_string(height) + " " + unit +
         "; allowed: up to " + std::to_string(max_side) + " a side");
  }

 private:
  std::span<const std::uint8_t> all_;
  const std::string& label_;
  std::size_t at_ = 0;
};

}  // namespace lacuna
