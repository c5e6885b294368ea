#include "renderer/gltf/gltf_skins.h"

#include <optional>

#include "renderer/gltf/gltf_accessors.h"

namespace lacuna::gltf {
namespace {

std::vector<M44d> pose_joints(const GltfObject& skin, const file::Model& model,
                              const std::vector<M44d>& to_world) {
  const auto joints = skin.indices("joints", to_world.size(), "nodes");
  if (joints.empty()) skin.fail("joints is missing or empty");
  std::optional<AccessorView> inverse_binds;
  if (const auto accessor =
          skin.index("inverseBindMatrices", model.accessors.size(), "accessors")) {
    inverse_binds.emplace(model, static_cast<int>(*accessor), ElementType::mat4, Components::floats,
                          "inverseBindMatrices of " + skin.label());
    if (inverse_binds->size() < joints.size()) {
      skin.fail("inverseBindMatrices has " + std::to_string(inverse_binds->size()) +
                " matrices for " + std::to_string(joints.size()) + " joints");
    }
  }
  std::vector<M44d> out(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const M44d inverse_bind = inverse_binds ? matrix_of(inverse_binds->floats<16>(j)) : M44d();
    out[j] = inverse_bind * to_world[joints[j]];
    if (!all_finite(out[j])) {
      skin.fail("the transform of joints[" + std::to_string(j) + "], nodes[" +
                std::to_string(joints[j]) +
                "], with its inverse bind matrix, is too large or not finite");
    }
  }
  return out;
}

}  // namespace

Skins pose_skins(const GltfObject& root, const file::Model& model,
                 const std::vector<PlacedNode>& nodes, const std::vector<M44d>& to_world) {
  const auto skins = root.objects("skins");
  Skins out(skins.size());
  for (const PlacedNode& node : nodes) {
    if (!node.skin || !out[*node.skin].empty()) continue;
    out[*node.skin] = pose_joints(skins[*node.skin], model, to_world);
  }
  return out;
}

}  // namespace lacuna::gltf
