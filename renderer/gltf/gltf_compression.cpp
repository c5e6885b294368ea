#include "renderer/gltf/gltf_compression.h"

#include "renderer/gltf/gltf_draco.h"
#include "renderer/gltf/gltf_meshopt.h"

namespace lacuna::gltf {

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
}

void decode_compressed(const GltfObject& root, file::Model& model) {
  decode_meshopt(root, model);
  decode_draco(root, model);
}

}  // namespace lacuna::gltf
