#pragma once

#include <optional>
#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"

namespace lacuna::gltf {

/// The nodes, with one for each instance in the place of a node with EXT_mesh_gpu_instancing; none
/// if no node has that. Throws SceneError if the attributes differ in length or are not what the
/// extension allows, and on more than 2^24 instances.
std::optional<std::vector<PlacedNode>> expand_instances(const file::Model& model,
                                                        const std::vector<PlacedNode>& nodes,
                                                        Warnings& warnings);

/// Which meshes are stored once and placed by instances, instead of one copy for each node.
class SharedMeshes {
 public:
  /// Those of two or more nodes, if the copies had more than 2^20 triangles together. Fewer are
  /// copied: rays are faster without instances, and the copies take some 200 MB at most.
  SharedMeshes(const file::Model& model, const std::vector<PlacedNode>& nodes,
               const std::vector<Material>& materials);

  /// Whether a node places an instance, by its index. Skinned and morphed meshes have a copy for
  /// each node, and so have those under transforms that single precision does not invert well.
  bool placed_as_instance(std::size_t node) const { return is_instance_[node]; }
  /// How many nodes do.
  std::size_t instances() const { return instances_; }

 private:
  std::vector<bool> is_instance_;  // of each node
  std::size_t instances_ = 0;
};

}  // namespace lacuna::gltf
