#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "jobs/import/glb_document.h"
#include "jobs/import/imported_scene.h"
#include "jobs/import/imported_textures.h"

namespace lacuna {

/// The materials of a scene that is being written: each as the nearest one of glTF and, where that
/// is not exact, with the extension LACUNA_materials. All arguments outlive it.
class ImportedMaterials {
 public:
  ImportedMaterials(GlbDocument& document, ImportedTextures& textures,
                    std::vector<ImportNote>& notes)
      : document_(document), textures_(textures), notes_(notes) {}

  /// The index of a material, which is written once for each radiance.
  std::size_t index(const std::shared_ptr<const ImportedMaterial>& material,
                    const std::optional<ImportedValue>& radiance = std::nullopt,
                    bool emits_behind = false);

 private:
  using Key =
      std::tuple<const ImportedMaterial*, const ImportedTexture*, float, float, float, bool, bool>;

  OrderedJson json_of(const ImportedMaterial& m);
  void add_standard(const ImportedMaterial& m, OrderedJson& json);
  void add_base(const ImportedMaterial& m, const ImportedValue& color, OrderedJson& json);
  void add_emission(const ImportedValue& radiance, OrderedJson& json);
  void add_exact(const ImportedMaterial& m, OrderedJson& json);
  void add_facets(const ImportedMaterial& m, OrderedJson& exact);
  void add_reflectance(const ImportedMaterial& m, OrderedJson& exact);
  void add_parts(const ImportedMaterial& m, OrderedJson& exact);
  /// A colour of at most 1; notes what is clamped.
  Rgb within_one(const ImportedMaterial& m, const Rgb& color, const std::string& what);

  GlbDocument& document_;
  ImportedTextures& textures_;
  std::vector<ImportNote>& notes_;
  std::map<Key, std::size_t> indices_;
  std::vector<std::shared_ptr<const ImportedMaterial>> kept_;  // the addresses are keys
};

}  // namespace lacuna
