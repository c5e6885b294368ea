#pragma once

#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_pose.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// Computes SceneData::origin, which is subtracted from all positions while they are doubles: ray
/// origins are offset in proportion to their coordinates, so precision is lost far from 0. The
/// result is 0, and no bit changes, unless the centre of the scene's bounding box is further than
/// 32 times the box's longest side from 0 along some axis. Then it is that centre, rounded to a
/// multiple of a power of two between 1/2 and 1 times that side, so that the subtraction itself
/// rounds nothing. The box bounds all vertices that triangles use: by the transformed boxes of
/// primitives, unless joints or morph targets move them.
V3d scene_origin(const file::Model& model, const std::vector<PlacedNode>& nodes,
                 const Skins& skins);

/// Warns of meshes that are too small for the size of their coordinates: those for which
/// is_far_for_its_size() holds in the scene, and `coarse` meshes for which it holds in the file,
/// whose coordinates are floats.
void warn_of_places(const SceneData& scene, std::uint64_t coarse, Warnings& warnings);

/// Warns of cameras whose position a float rounds by 2^-10 of the scene's longest side or more.
void warn_of_far_cameras(const SceneData& scene, Warnings& warnings);

/// Whether the largest coordinate of a box is more than 2^14 times its longest side. Then a float
/// resolves positions only to 2^-10 of that side, and rays start up to 2^-8 of it off surfaces.
bool is_far_for_its_size(const Bounds& box);

}  // namespace lacuna::gltf
