#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lacuna {

// Values are stored with their bytes in memory; every format is little-endian.
static_assert(std::endian::native == std::endian::little);

/// put() for a writer that has `append(const void*, std::size_t)`: plain values, lists and texts;
/// the length of the latter two precedes them, 64 bits.
template <class Writer>
class PutsValues {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { writer().append(&value, sizeof(T)); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(std::span<T> values) {
    put(static_cast<std::uint64_t>(values.size()));
    writer().append(values.data(), sizeof(T) * values.size());
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(std::span(values));
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
  /// Reads the number of values of `size` bytes that follow.
  std::size_t get_length(std::size_t size) {
    const auto n = get<std::uint64_t>();
    if (n > reader().remaining() / size) throw std::runtime_error("saved state ends early");
    return static_cast<std::size_t>(n);
  }

 private:
  Reader& reader() { return static_cast<Reader&>(*this); }
};

/// Most bytes per call of ByteWriter's sink and of ByteReader's source.
inline constexpr std::size_t piece_bytes = std::size_t{1} << 20;

/// Appends plain values to a byte string, or passes them to a sink in pieces, so that only one
/// piece is in memory.
class ByteWriter : public PutsValues<ByteWriter> {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// Collects in bytes().
  ByteWriter() = default;
  /// Passes pieces of 1 to piece_bytes bytes to `sink` in order, the last one in flush().
  explicit ByteWriter(Sink sink) : sink_(std::move(sink)) {}

  void append(const void* from, std::size_t n) {
    if (sink_ && n > piece_bytes - bytes_.size())
      return hand_on({static_cast<const char*>(from), n});
    bytes_.append(static_cast<const char*>(from), n);
  }
  /// Passes the rest to the sink; without one, does nothing.
  void flush();

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  void hand_on(std::string_view more);

  std::string bytes_;
  Sink sink_;
};

/// Reads what ByteWriter wrote, in the same order. Throws std::runtime_error where the bytes end
/// early.
class ByteReader : public GetsValues<ByteReader> {
 public:
  /// Reads the next n bytes.
  using Source = std::function<void(char* to, std::size_t n)>;

  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  /// Reads `size` bytes from `source`, in pieces of 1 to piece_bytes bytes.
  ByteReader(std::uint64_t size, Source source) : ahead_(size), source_(std::move(source)) {}
  ByteReader(const ByteReader&) = delete;  // it points into itself
  ByteReader& operator=(const ByteReader&) = delete;

  void read(void* to, std::size_t n) {
    if (n > bytes_.size()) return read_on(static_cast<char*>(to), n);
    if (n > 0) std::memcpy(to, bytes_.data(), n);  // an empty vector has no data
    bytes_.remove_prefix(n);
  }
  std::uint64_t remaining() const { return bytes_.size() + ahead_; }
  bool at_end() const { return remaining() == 0; }
  /// Skips all remaining bytes.
  void skip() {
    bytes_ = {};
    ahead_ = 0;
  }

 private:
  void read_on(char* to, std::size_t n);

  std::string_view bytes_;   // in memory
  std::uint64_t ahead_ = 0;  // not yet read from the source
  Source source_;
  std::string buffer_;
};

}  // namespace lacuna
