#include "renderer/gltf/gltf_compression.h"

#include "renderer/gltf/gltf_draco.h"
#include "renderer/gltf/gltf_meshopt.h"

namespace lacuna::gltf {
namespace {

/// Accessors without data are zeros, and claim a size that no bytes stand for. Those that Draco
/// fills have other limits.
void check_zeros(const GltfObject& root) {
  constexpr std::uint64_t max_zeros = std::uint64_t{1} << 24;
  const auto accessors = root.objects("accessors");
  std::vector<bool> filled(accessors.size());
  const auto fill = [&](const GltfObject& owner, const std::string& key) {
    if (const auto i = owner.index(key, accessors.size(), "accessors")) filled[*i] = true;
  };
  for (const GltfObject& mesh : root.objects("meshes")) {
    for (const GltfObject& primitive : mesh.objects("primitives")) {
      const auto draco = needed_draco(primitive, accessors);
      if (!draco) continue;
      fill(primitive, "indices");
      for (const std::string& name : draco->object("attributes")->keys()) {
        fill(*primitive.object("attributes"), name);
      }
    }
  }
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    if (filled[i] || accessors[i].has("bufferView")) continue;
    if (accessors[i].integer("count", 1, ~std::uint32_t{0}) > max_zeros) {
      accessors[i].refuse("count",
                          "at most " + std::to_string(max_zeros) + " without a bufferView");
    }
  }
}

}  // namespace

bool is_fallback(const GltfObject& buffer) {
  const auto extension = buffer.extension(meshopt_extension);
  return extension && extension->boolean("fallback", false);
}

std::optional<GltfObject> needed_draco(const GltfObject& primitive,
                                       const std::vector<GltfObject>& accessors) {
  auto draco = primitive.extension(draco_extension);
  if (!draco) return std::nullopt;
  const auto held = draco->object("attributes");
  if (!held) draco->fail("attributes is missing");
  const auto lacks_data = [&](const std::optional<std::size_t>& accessor) {
    return accessor && !accessors[*accessor].has("bufferView");
  };
  bool needed = lacks_data(primitive.index("indices", accessors.size(), "accessors"));
  const auto attributes = primitive.object("attributes");
  for (const std::string& name : held->keys()) {
    needed = needed || lacks_data(attributes->index(name, accessors.size(), "accessors"));
  }
  return needed ? std::move(draco) : std::nullopt;
}

void check_compression(const GltfObject& root) {
  check_meshopt(root);
  check_draco(root);
  check_zeros(root);
}

void decode_compressed(const GltfObject& root, file::Model& model) {
  decode_meshopt(root, model);
  decode_draco(root, model);
}

}  // namespace lacuna::gltf
