#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/settings/field.h"

namespace lacuna {

/// What a file is to the result that was made from it.
enum class InputRole { scene, buffer, texture, environment, reference };

template <>
struct EnumTable<InputRole> {
  static constexpr std::array<EnumValue<InputRole>, 5> values{{
      {InputRole::scene, "scene", "the scene file"},
      {InputRole::buffer, "buffer", "a file of vertices that the scene names"},
      {InputRole::texture, "texture", "an image that the scene names"},
      {InputRole::environment, "environment", "the image of the environment"},
      {InputRole::reference, "reference", "the picture that errors are measured against"},
  }};
};

/// A file that a result was made from, as it was when it was read.
struct InputFile {
  InputRole role = InputRole::scene;
  std::string name = {};  ///< as the job names it, or the scene (`uri`)
  std::uint64_t bytes = 0;
  std::string hash = {};  ///< XXH3-64 of the content, 16 hexadecimal digits; empty: it is not there
  bool operator==(const InputFile&) const = default;
};

using InputBytes = std::vector<std::uint8_t>;

// The functions below are the only ones that open a file which a picture is made from, and the one
// place where a fault that may pass is told from a file that is wrong.

/// Throws InputUnreadable if what was met (`error`, an errno) with `file` may pass: may_pass(); or
/// the file is missing, and `folder`, where it is looked for, is missing or empty, as a share that
/// is not mounted.
void throw_if_it_may_pass(int error, const std::filesystem::path& file,
                          const std::filesystem::path& folder);

/// The whole of a regular file of at most `max_bytes`; links are followed. Sets size and hash in
/// `about`. Throws InputUnreadable; if the file itself is wrong std::invalid_argument, and
/// std::length_error if it is larger, with the reason, which does not name the file.
InputBytes read_input(const std::filesystem::path& file, std::uint64_t max_bytes, InputFile& about);

/// The size and the hash of a file; no hash if the size is not `expected`. Throws as read_input().
InputFile measure_input(const std::filesystem::path& file,
                        std::optional<std::uint64_t> expected = std::nullopt);

}  // namespace lacuna
