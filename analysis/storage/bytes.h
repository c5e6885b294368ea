#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lacuna {

// Values are stored as they lie in memory; that this is little-endian is part of every format.
static_assert(std::endian::native == std::endian::little);

/// put() for a writer that has `append(const void*, std::size_t)`: plain values, lists and texts;
/// the latter two with their length as 64 bits in front.
template <class Writer>
class PutsValues {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { writer().append(&value, sizeof(T)); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    writer().append(values.data(), sizeof(T) * values.size());
  }
  void put(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    writer().append(text.data(), text.size());
  }

 private:
  Writer& writer() { return static_cast<Writer&>(*this); }
};

/// get() of the same for a reader that has `read(void*, std::size_t)`, which throws
/// std::runtime_error where the bytes end early, and `remaining()`. A length that the remaining
/// bytes cannot hold is refused before anything is allocated.
template <class Reader>
class GetsValues {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T> T get() {
    T value;
    reader().read(&value, sizeof(T));
    return value;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T> std::vector<T> get_vector() {
    std::vector<T> values(get_length(sizeof(T)));
    if (!values.empty()) reader().read(values.data(), sizeof(T) * values.size());
    return values;
  }
  std::string get_string() {
    std::string text(get_length(1), '\0');
    reader().read(text.data(), text.size());
    return text;
  }
  /// How many values of `size` bytes follow.
  std::size_t get_length(std::size_t size) {
    const auto n = get<std::uint64_t>();
    if (n > reader().remaining() / size) throw std::runtime_error("saved state ends early");
    return static_cast<std::size_t>(n);
  }

 private:
  Reader& reader() { return static_cast<Reader&>(*this); }
};

/// Appends plain values to a byte string.
class ByteWriter : public PutsValues<ByteWriter> {
 public:
  void append(const void* from, std::size_t n) { bytes_.append(static_cast<const char*>(from), n); }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what ByteWriter wrote, in the same order. Throws std::runtime_error where the bytes end
/// early.
class ByteReader : public GetsValues<ByteReader> {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::string_view get_text() { return take(get<std::uint64_t>()); }
  void read(void* to, std::size_t n) {
    const std::string_view from = take(n);
    if (n > 0) std::memcpy(to, from.data(), n);  // an empty vector has no data
  }
  std::uint64_t remaining() const { return bytes_.size(); }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view take(std::uint64_t n) {
    if (n > bytes_.size()) throw std::runtime_error("saved state ends early");
    const std::string_view head = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
    return head;
  }
  std::string_view bytes_;
};

}  // namespace lacuna
