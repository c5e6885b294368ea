#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "jobs/import/imported_scene.h"

namespace lacuna::mitsuba {

/// Reads all triangles of a Wavefront OBJ, whatever their groups and materials; polygons are
/// triangulated. Throws SceneError with `label`.
ImportedMesh obj_mesh(const std::string& text, const std::string& label);

/// Reads mesh `index` of a file of Mitsuba's own format (version 3 or 4): compressed by zlib,
/// texture coordinates as they stand. `face_normals`: the file asks for flat triangles. Throws
/// SceneError with `label` where the file is truncated or claims more than its compressed bytes can
/// hold.
ImportedMesh serialized_mesh(std::span<const std::uint8_t> file, std::uint64_t index,
                             const std::string& label, bool* face_normals = nullptr);

}  // namespace lacuna::mitsuba
