#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/settings/field.h"

namespace lacuna {

/// The role of a file among the inputs of a result.
enum class InputRole { scene, buffer, texture, environment, reference, picture };

template <>
struct EnumTable<InputRole> {
  static constexpr std::array<EnumValue<InputRole>, 6> values{{
      {InputRole::scene, "scene", "the scene file"},
      {InputRole::buffer, "buffer", "a file of vertices that the scene names"},
      {InputRole::texture, "texture", "an image that the scene names"},
      {InputRole::environment, "environment", "the image of the environment"},
      {InputRole::reference, "reference", "the picture that errors are measured against"},
      {InputRole::picture, "picture", "a picture that another program has rendered"},
  }};
};

/// An input file of a result, as it was when it was read.
struct InputFile {
  InputRole role = InputRole::scene;
  std::string name = {};  ///< in the job, or in the scene (`uri`)
  std::uint64_t bytes = 0;
  std::string hash = {};  ///< XXH3-64 of the content, 16 hexadecimal digits; empty: missing
  bool operator==(const InputFile&) const = default;
};

using InputBytes = std::vector<std::uint8_t>;

// Only the functions below open the input files of a picture, and only they distinguish transient
// errors from invalid files.

/// Throws InputUnreadable if `error` (an errno) of `file` is transient (may_pass()), or if the file
/// is missing and `folder`, where it is looked up, is missing or empty, as an unmounted share is.
void throw_if_it_may_pass(int error, const std::filesystem::path& file,
                          const std::filesystem::path& folder);

/// Reads a regular file of at most `max_bytes`, following links. Sets size and hash in `about`.
/// Throws InputUnreadable, std::invalid_argument if the file is invalid, and std::length_error if
/// it is larger; the latter two give a reason that does not name the file.
InputBytes read_input(const std::filesystem::path& file, std::uint64_t max_bytes, InputFile& about);

/// The size and the hash of a file; no hash if the size is not `expected`. Throws as read_input().
InputFile measure_input(const std::filesystem::path& file,
                        std::optional<std::uint64_t> expected = std::nullopt);

}  // namespace lacuna
