#pragma once

#include <vector>

#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// SceneData::origin. A scene that lies far from the file's origin is moved there while its
/// coordinates still are doubles, for rays start beside surfaces by a share of the coordinates. Far
/// means: the centre of its box is more than 32 times the box's longest side away, along some
/// axis. Then the origin is that centre, rounded to a multiple of a power of two between a half and
/// all of that side, so that the move by itself rounds nothing; else it is 0, and no bit changes.
/// The box is one around the boxes of all placed primitives, of vertices that triangles use.
V3d scene_origin(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes);

/// Warns of meshes that are too small for where they lie: in the scene, where ray origins are
/// offset in proportion to the distance from its origin, and in their own coordinates, which are
/// floats in the file (`coarse`: how many meshes have coordinates too coarse for them).
void warn_of_places(const SceneData& scene, std::uint64_t coarse, Warnings& warnings);

/// Warns of cameras so far away that a float rounds their place by 2^-10 of the scene's longest
/// side or more.
void warn_of_far_cameras(const SceneData& scene, Warnings& warnings);

/// The largest coordinate of a box is more than 2^14 times its longest side:
/// a float resolves them to 2^-10 of their size, and rays start a thirty-second of it beside them.
bool is_far_for_its_size(const Bounds& box);

}  // namespace lacuna::gltf
