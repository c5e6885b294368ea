#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna::gltf {

using Json = nlohmann::json;

/// The numbers that a field may hold, both ends included.
struct Range {
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::max();
};

inline constexpr Range non_negative{0, std::numeric_limits<float>::max()};
inline constexpr Range unit_interval{0, 1};
inline constexpr Range any_float{std::numeric_limits<float>::lowest(),
                                 std::numeric_limits<float>::max()};

/// An object of the JSON together with its place in the file. Every read checks the type and the
/// range and throws a SceneError that names the place, what was found and what is allowed.
/// tinygltf reads wrong types as defaults and truncates integers, so nothing it parsed leniently is
/// trusted before it was read through here.
class Place {
 public:
  /// Throws if `value` is not an object.
  Place(const Json& value, std::string path);

  const std::string& path() const { return path_; }
  /// The path and, where there is one, the object's name.
  std::string label() const;
  bool has(std::string_view key) const { return find(key) != nullptr; }

  double number(std::string_view key, double fallback, Range allowed) const;
  double number(std::string_view key, Range allowed) const;  ///< required
  std::uint64_t integer(std::string_view key, std::uint64_t low, std::uint64_t high) const;
  std::uint64_t integer(std::string_view key, std::uint64_t fallback, std::uint64_t low,
                        std::uint64_t high) const;
  bool boolean(std::string_view key, bool fallback) const;
  std::string string(std::string_view key) const;  ///< required
  std::string string(std::string_view key, const std::string& fallback) const;

  /// An index into the top-level array `target` of `size` elements; none if the key is absent.
  std::optional<std::size_t> index(std::string_view key, std::size_t size,
                                   std::string_view target) const;
  /// An array of such indices; empty if the key is absent.
  std::vector<std::size_t> indices(std::string_view key, std::size_t size,
                                   std::string_view target) const;
  /// An array of exactly N numbers; none if the key is absent.
  template <std::size_t N>
  std::optional<std::array<double, N>> numbers(std::string_view key, Range allowed) const;

  /// The object under `key`; none if the key is absent.
  std::optional<Place> object(std::string_view key) const;
  /// `extensions.name`; none if there is none.
  std::optional<Place> extension(std::string_view name) const;
  /// An array of objects; empty if the key is absent.
  std::vector<Place> objects(std::string_view key) const;
  std::size_t array_size(std::string_view key) const;

  /// An array of strings; empty if the key is absent.
  std::vector<std::string> strings(std::string_view key) const;
  std::vector<std::string> keys() const;

  /// Throws: `found` stands at `key`, where only `allowed` is.
  [[noreturn]] void refuse(std::string_view key, const std::string& found,
                           const std::string& allowed) const;
  [[noreturn]] void refuse(std::string_view key, double found, const std::string& allowed) const;
  /// Throws with the place in front of `message`.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void refuse_json(std::string_view key, const Json& found,
                                const std::string& allowed) const;
  const Json* find(std::string_view key) const;
  const Json& require(std::string_view key, const std::string& allowed) const;
  const Json* array(std::string_view key) const;
  double checked_number(std::string_view key, const Json& found, Range allowed) const;
  void numbers(std::string_view key, Range allowed, std::size_t count, double* out) const;
  std::string path_of(std::string_view key) const;

  const Json* value_;
  std::string path_;
};

template <std::size_t N>
std::optional<std::array<double, N>> Place::numbers(std::string_view key, Range allowed) const {
  if (!has(key)) return std::nullopt;
  std::array<double, N> out;
  numbers(key, allowed, N, out.data());
  return out;
}

}  // namespace lacuna::gltf
