#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "jobs/import/imported_scene.h"
#include "jobs/import/mitsuba/scene_element.h"

namespace lacuna::mitsuba {

/// A Wavefront OBJ, whatever its groups: the triangles of each material (usemtl), in the order of
/// their first; polygons are triangulated.
struct ObjFile {
  struct Part {
    std::string material;  ///< empty: none
    ImportedMesh mesh;
  };
  std::vector<Part> parts;
  std::vector<std::string> libraries;  ///< mtllib
};
/// Throws SceneError with `label`.
ObjFile obj_file(const std::string& text, const std::string& label);

/// The BSDFs that Mitsuba 0.6 makes of an MTL's materials, by name. Pictures lie in `folder`, which
/// is empty or ends with a slash.
std::map<std::string, SceneElement> mtl_bsdfs(const std::string& text, const std::string& folder,
                                              const std::string& place);

/// Reads mesh `index` of a file of Mitsuba's own format (version 3 or 4): compressed by zlib,
/// texture coordinates as they stand. `face_normals`: the file asks for flat triangles. Throws
/// SceneError with `label` where the file is truncated or claims more than its compressed bytes can
/// hold.
ImportedMesh serialized_mesh(std::span<const std::uint8_t> file, std::uint64_t index,
                             const std::string& label, bool* face_normals = nullptr);

}  // namespace lacuna::mitsuba
