#pragma once

#include <filesystem>
#include <optional>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// The version that a file and its includes are written for: by film, materials, texture types and
/// statements, the first of them. None if there is no such statement.
std::optional<Version> find_version(const std::filesystem::path& file);

}  // namespace lacuna::pbrt
