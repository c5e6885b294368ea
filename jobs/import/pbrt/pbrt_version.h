#pragma once

#include <filesystem>
#include <optional>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// The version that the main file (without its includes) is written for: by its film, materials,
/// texture types and statements. None if there is no such statement.
std::optional<Version> find_version(const std::filesystem::path& file);

}  // namespace lacuna::pbrt
