#include "renderer/gltf/gltf_compression.h"

#include "renderer/gltf/gltf_draco.h"
#include "renderer/gltf/gltf_meshopt.h"

namespace lacuna::gltf {
namespace {

/// Accessors without data are zeros, and claim a size that no bytes stand for.
void check_zeros(const GltfObject& root) {
  constexpr std::uint64_t max_zeros = std::uint64_t{1} << 24;
  for (const GltfObject& accessor : root.objects("accessors")) {
    if (accessor.has("bufferView")) continue;
    if (accessor.integer("count", 1, ~std::uint32_t{0}) > max_zeros) {
      accessor.refuse("count", "at most " + std::to_string(max_zeros) + " without a bufferView");
    }
  }
}

}  // namespace

bool is_fallback(const GltfObject& buffer) {
  const auto extension = buffer.extension(meshopt_extension);
  return extension && extension->boolean("fallback", false);
}

void check_compression(const GltfObject& root) {
  check_meshopt(root);
  if (check_draco(root) > max_decoded_bytes) {
    root.fail("all meshes of " + std::string(draco_extension) + " decode to more than " +
              std::to_string(max_decoded_bytes) + " bytes");
  }
  check_zeros(root);
}

}  // namespace lacuna::gltf
