#pragma once

#include <optional>
#include <string>

#include "renderer/core/scene_error.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_accessors.h"
#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_pose.h"
#include "renderer/gltf/gltf_triangles.h"

namespace lacuna::gltf {

inline bool is_drawn(const file::Primitive& primitive) {
  return is_triangle_mode(primitive.mode) && primitive.attributes.contains("POSITION");
}

/// Index into the scene's materials, the last of which is glTF's default.
inline std::size_t material_of(const file::Primitive& primitive,
                               const std::vector<Material>& materials) {
  return primitive.material >= 0 ? static_cast<std::size_t>(primitive.material)
                                 : materials.size() - 1;
}

/// The index of a node's mesh; none if it has no mesh, if it is invisible, or if its scale leaves
/// nothing of it. A skinned mesh is placed by its joints, whatever the scale of its node.
inline std::optional<std::size_t> mesh_of(const file::Model& model, const PlacedNode& node) {
  if (!node.visible || (node.rank < 2 && !node.skin)) return std::nullopt;
  return node.place.index("mesh", model.meshes.size(), "meshes");
}

/// An instance of a primitive: the primitive and the node that places it.
struct Source {
  const file::Model& model;
  std::size_t mesh, index;
  const PlacedNode& node;
  const Skins& skins;

  const file::Primitive& primitive() const { return model.meshes[mesh].primitives[index]; }
  /// Names the instance in errors.
  std::string place() const {
    return "meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(index) + "] under " +
           node.place.label();
  }
  /// The accessor of an attribute; -1 if there is none.
  int attribute(const std::string& name) const {
    const auto it = primitive().attributes.find(name);
    return it == primitive().attributes.end() ? -1 : it->second;
  }
  /// The elements of an attribute, as many as POSITION has.
  AccessorView view(const std::string& name, ElementType type, Components components) const {
    return view_of(attribute(name), name, type, components);
  }
  AccessorView view_of(int accessor, const std::string& name, ElementType type,
                       Components components) const {
    const std::string use = name + " of " + place();
    AccessorView out(model, accessor, type, components, use);
    const auto vertices =
        model.accessors[static_cast<std::size_t>(primitive().attributes.at("POSITION"))].count;
    if (out.size() != vertices) {
      throw SceneError(use + ": " + std::to_string(out.size()) + " elements for " +
                       std::to_string(vertices) + " vertices");
    }
    return out;
  }
  /// Whether joints place the vertices, instead of the node.
  bool skinned() const {
    return node.skin && attribute("JOINTS_0") >= 0 && attribute("WEIGHTS_0") >= 0;
  }
  /// Whether the scale of its node leaves nothing of it.
  bool hidden() const { return node.rank < 2 && !skinned(); }
};

}  // namespace lacuna::gltf
