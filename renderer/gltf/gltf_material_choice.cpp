#include "renderer/gltf/gltf_material_choice.h"

#include <algorithm>
#include <optional>

#include "renderer/core/scene_error.h"

namespace lacuna::gltf {
namespace {

constexpr std::string_view variants_extension = "KHR_materials_variants";

/// The number of the variant called `name`.
std::size_t variant_of(const GltfObject& root, const std::string& name) {
  std::string names;
  if (const auto list = root.extension(variants_extension)) {
    std::size_t i = 0;
    for (const GltfObject& variant : list->objects("variants")) {
      const std::string own = variant.string("name");
      if (own == name) return i;
      names += (names.empty() ? "" : ", ") + in_quotes(own);
      ++i;
    }
  }
  throw SceneError("there is no variant " + in_quotes(name) + "; allowed: " +
                   (names.empty() ? "none, as the file has no KHR_materials_variants" : names));
}

/// The material that a mapping of the primitive gives the variant; none: its own.
std::optional<std::size_t> mapped(const GltfObject& primitive, std::size_t variant,
                                  std::size_t variants, std::size_t materials) {
  const auto own = primitive.extension(variants_extension);
  if (!own) return std::nullopt;
  for (const GltfObject& mapping : own->objects("mappings")) {
    const auto listed = mapping.indices("variants", variants, variants_extension);
    if (std::ranges::find(listed, variant) == listed.end()) continue;
    return mapping.index("material", materials, "materials");
  }
  return std::nullopt;
}

void choose_variant(const GltfObject& root, const std::string& variant, std::size_t materials,
                    file::Model& model) {
  const std::size_t chosen = variant_of(root, variant);
  const std::size_t variants = root.extension(variants_extension)->array_size("variants");
  std::size_t m = 0;
  for (const GltfObject& mesh : root.objects("meshes")) {
    std::size_t p = 0;
    for (const GltfObject& primitive : mesh.objects("primitives")) {
      if (const auto material = mapped(primitive, chosen, variants, materials)) {
        model.meshes[m].primitives[p].material = static_cast<int>(*material);
      }
      ++p;
    }
    ++m;
  }
}

}  // namespace

void choose_materials(const GltfObject& root, const std::string& variant, std::size_t materials,
                      file::Model& model) {
  if (!variant.empty()) choose_variant(root, variant, materials - 1, model);
  for (file::Mesh& mesh : model.meshes) {
    for (file::Primitive& primitive : mesh.primitives) {
      if (primitive.material < 0) primitive.material = static_cast<int>(materials - 1);
    }
  }
}

}  // namespace lacuna::gltf
