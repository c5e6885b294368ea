#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "base/storage/atomic_file.h"
#include "jobs/spec/described_json.h"

namespace lacuna {

/// Reads a small file that Lacuna itself has written: one described struct, within `limits`. Throws
/// std::system_error, and std::runtime_error if it is corrupt.
template <Described T>
T read_own(const std::filesystem::path& path, DocumentLimits limits = {1 << 20, 8}) {
  try {
    return read_document<T>(read_file(path, limits.max_bytes), limits);
  } catch (const BadJob& e) {
    throw std::runtime_error(fmt::format("{} is corrupt: {}", path.string(), e.what()));
  } catch (const std::length_error& e) {
    throw std::runtime_error(fmt::format("{} is corrupt: {}", path.string(), e.what()));
  }
}

}  // namespace lacuna
