#pragma once

#include <memory>
#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_warnings.h"
#include "renderer/images/guards.h"

namespace lacuna::gltf {

/// The textures that materials use. Each combination of an image, an encoding (sRGB or linear) and
/// wrap modes is one texture: an image that is used as colour and as data becomes two.
class TextureTable {
 public:
  /// `root` must outlive the table.
  TextureTable(const GltfObject& root, Warnings& warnings);

  /// Reads the textureInfo under `key`, with KHR_texture_transform. It is always validated; the
  /// texture is added to the table only if `needed`, that is if its factor is not 0. Throws
  /// SceneError.
  TextureRef reference(const GltfObject& owner, std::string_view key, Texture::Encoding encoding,
                       bool needed);

  /// The texture of an image without a textureInfo, clamped at its edges.
  int clamped(std::size_t image, Texture::Encoding encoding) {
    return enter({image, encoding, Texture::Wrap::clamp, Texture::Wrap::clamp});
  }

  /// Creates all textures of the table with their encoded bytes. Throws SceneError if an image is
  /// missing, or if all textures together have more than `most_bytes`, encoded.
  std::vector<std::unique_ptr<Texture>> build(const file::Model& model, SceneFolder& folder,
                                              Hasher& content,
                                              std::uint64_t most_bytes = max_encoded_bytes) const;

 private:
  struct Entry {
    std::size_t image;
    Texture::Encoding encoding;
    Texture::Wrap wrap_s, wrap_t;
    bool operator==(const Entry&) const = default;
  };
  /// The index of the image to read. Throws SceneError where there is none of a known kind.
  std::size_t source_of(const GltfObject& texture) const;
  int enter(const GltfObject& texture, Texture::Encoding encoding);
  int enter(const Entry& entry);

  Warnings& warnings_;
  std::vector<GltfObject> textures_, images_, samplers_;
  std::vector<Entry> entries_;
};

}  // namespace lacuna::gltf
