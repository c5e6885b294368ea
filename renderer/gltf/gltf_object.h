#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json/json_cursor.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

inline constexpr Limits non_negative{0, std::numeric_limits<float>::max()};
inline constexpr Limits unit_interval{0, 1};
inline constexpr Limits any_float{std::numeric_limits<float>::lowest(),
                                  std::numeric_limits<float>::max()};

/// Tolerance beyond the ends of a range, within which a value is clamped, relative to the larger
/// end (to 1 if there is none): files store few digits, and tools accumulate rounding errors.
inline constexpr double hair = 0.01;

/// Refuses a file at the first problem: throws a SceneError that names the place as
/// "nodes[3] "door": rotation[2]", with the name of the innermost object.
class GltfProblems final : public JsonProblems {
 public:
  /// `root` and `warnings` outlive it.
  GltfProblems(const Json& root, Warnings& warnings) : root_(root), warnings_(warnings) {}
  [[noreturn]] void add(const std::string& pointer, const std::string& message) override;
  /// Warns of the first problem of a `kind` that refuses nothing, and counts the others.
  void warn(const std::string& kind, const std::string& pointer, const std::string& message);
  std::string place(const std::string& pointer) const;

 private:
  const Json& root_;
  Warnings& warnings_;
};

/// An object of the JSON, read by its keys. Every function that reads throws a SceneError if the
/// value is not allowed. tinygltf reads wrong types as defaults and truncates integers, so all
/// values are validated here before tinygltf's are used. Numbers slightly outside of their range
/// are clamped with a warning.
class GltfObject {
 public:
  /// The root object of the file that `problems` reports on. `problems` must outlive all objects.
  GltfObject(const Json& root, GltfProblems& problems)
      : GltfObject(JsonCursor(root, "", problems), problems) {}

  /// The place and, if it has one, the object's name.
  std::string label() const { return problems_->place(cursor_.pointer()); }
  bool has(std::string_view key) const;

  double number(std::string_view key, double fallback, const Limits& allowed) const;
  double number(std::string_view key, const Limits& allowed) const;  ///< required
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
  /// An array of arrays of such indices; empty if the key is absent.
  std::vector<std::vector<std::size_t>> index_lists(std::string_view key, std::size_t size,
                                                    std::string_view target) const;
  /// An array of exactly N numbers; none if the key is absent.
  template <std::size_t N>
  std::optional<std::array<double, N>> numbers(std::string_view key, const Limits& allowed) const;
  /// An array of any number of numbers; empty if the key is absent.
  std::vector<double> number_list(std::string_view key, const Limits& allowed) const;
  /// A number, as one element, or an array of numbers; empty if the key is absent.
  std::vector<double> one_or_more(std::string_view key, const Limits& allowed) const;
  /// A colour of light. glTF allows components up to 1; larger ones are more light, and are warned
  /// of.
  std::optional<std::array<double, 3>> light_colour(std::string_view key) const;

  /// The object under `key`; none if the key is absent.
  std::optional<GltfObject> object(std::string_view key) const;
  /// `extensions.name`; none if there is none.
  std::optional<GltfObject> extension(std::string_view name) const;
  /// An array of objects; empty if the key is absent.
  std::vector<GltfObject> objects(std::string_view key) const;
  std::size_t array_size(std::string_view key) const;

  /// A string in `extras`, which may be anything; empty if there is none.
  std::string extra(std::string_view key) const;

  /// An array of strings; empty if the key is absent.
  std::vector<std::string> strings(std::string_view key) const;
  std::vector<std::string> keys() const;

  /// Throws: the value at `key`, which must exist, is not what is `allowed`.
  [[noreturn]] void refuse(std::string_view key, const std::string& allowed) const;
  /// Throws with the place in front of `message`.
  [[noreturn]] void fail(const std::string& message) const;
  /// Warns of the first problem of a kind, with its place.
  void warn(const std::string& kind, const std::string& message) const;

 private:
  GltfObject(JsonCursor cursor, GltfProblems& problems);

  JsonCursor require(std::string_view key, std::string_view required) const;
  /// A number, clamped if it is slightly outside of what is allowed.
  double read(const JsonCursor& found, std::string_view key, const Limits& allowed) const;
  /// The elements of an array; none if the key is absent.
  std::vector<JsonCursor> elements(std::string_view key) const;

  JsonCursor cursor_;
  GltfProblems* problems_;
};

template <std::size_t N>
std::optional<std::array<double, N>> GltfObject::numbers(std::string_view key,
                                                         const Limits& allowed) const {
  const auto list = cursor_.find(key);
  if (!list) return std::nullopt;
  list->check_list_of(N);
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = read(list->at(i), key, allowed);
  return out;
}

}  // namespace lacuna::gltf
