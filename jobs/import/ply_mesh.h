#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Largest mesh file that an import reads, in bytes, and that a compressed one may become.
inline constexpr std::uint64_t max_mesh_bytes = std::uint64_t{4} << 30;

/// Reads the triangles of a PLY file (ascii, binary of either byte order): x y z, nx ny nz, u v (or
/// s t, texture_u texture_v) as they stand, and r g b (or red green blue; integers are divided by
/// their largest value). Polygons become fans. Other elements and properties are skipped; their
/// names are appended to `skipped` if it is not null. Throws SceneError with `label` where the file
/// is not a PLY, is shorter than its header says, or names a vertex that is not there.
ImportedMesh ply_mesh(std::span<const std::uint8_t> file, const std::string& label,
                      std::vector<std::string>* skipped = nullptr);

}  // namespace lacuna
