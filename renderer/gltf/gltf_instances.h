#pragma once

#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"

namespace lacuna::gltf {

/// Replaces each node with EXT_mesh_gpu_instancing by one node for each of its instances. Throws
/// SceneError if the attributes differ in length or are not what the extension allows, and on more
/// than 2^24 instances.
std::vector<PlacedNode> expand_instances(const file::Model& model, std::vector<PlacedNode> nodes,
                                         Warnings& warnings);

/// Which meshes are stored once and placed by instances, instead of one copy for each node.
class SharedMeshes {
 public:
  /// Those of two or more nodes, if the copies had more than 2^20 triangles together. Fewer are
  /// copied: rays are faster without instances, and the copies take some 200 MB at most.
  SharedMeshes(const file::Model& model, const std::vector<PlacedNode>& nodes,
               const std::vector<Material>& materials);

  /// Whether a node places an instance. Skinned and morphed meshes have a copy for each node, and
  /// so have those under transforms that single precision does not invert well.
  bool placed_as_instance(const file::Model& model, const PlacedNode& node) const;

 private:
  std::vector<bool> shared_;  // of each mesh
  bool any_ = false;
};

}  // namespace lacuna::gltf
