#pragma once

#include <memory>
#include <vector>

#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// Which textures the materials use, each once for every way of reading it: a texture that serves
/// both as colour and as data becomes two.
class TextureTable {
 public:
  /// `root` must outlive the table.
  TextureTable(const GltfObject& root, Warnings& warnings);

  /// The textureInfo under `key`, with KHR_texture_transform. Checked in any case; entered into the
  /// table only if `needed`, that is if its factor is not 0. Throws SceneError.
  TextureRef reference(const GltfObject& owner, std::string_view key, Texture::Encoding encoding,
                       bool needed);

  /// Takes the encoded bytes of all entries. Throws SceneError if one is missing.
  std::vector<std::unique_ptr<Texture>> build(const tinygltf::Model& model, SceneFolder& folder,
                                              Hasher& content) const;

 private:
  struct Entry {
    std::size_t image;
    Texture::Encoding encoding;
    Texture::Wrap wrap_s, wrap_t;
    bool operator==(const Entry&) const = default;
  };
  int enter(const GltfObject& texture, Texture::Encoding encoding);

  Warnings& warnings_;
  std::vector<GltfObject> textures_, images_, samplers_;
  std::vector<Entry> entries_;
};

}  // namespace lacuna::gltf
