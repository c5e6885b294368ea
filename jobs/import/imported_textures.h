#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "jobs/import/glb_document.h"
#include "jobs/import/imported_scene.h"
#include "jobs/import/linear_picture.h"

namespace lacuna {

/// The textures of a scene that is being written: files in a folder, and what names them in the
/// document. A picture is copied where glTF reads it as it is, else converted to a PNG of 8 bits;
/// what is lost goes into the notes. Each function returns a textureInfo of glTF and throws
/// SceneError or std::system_error.
class ImportedTextures {
 public:
  /// Files go to `folder`/textures. All arguments outlive it.
  ImportedTextures(GlbDocument& document, std::filesystem::path folder,
                   std::vector<ImportNote>& notes)
      : document_(document), folder_(std::move(folder)), notes_(notes) {}

  /// A colour: encoded by sRGB's curve. If `scale` is not null, the picture's values are divided by
  /// its largest one above 1 and `scale` is set to that; else they are clipped to 1.
  OrderedJson color(const ImportedTexture& texture, double* scale = nullptr);
  /// A colour (null: white) with `opacity` as its alpha.
  OrderedJson color_with_alpha(const ImportedTexture* color, const ImportedValue& opacity);
  /// Factors of glTF's metallic-roughness model (null: 1) as its blue and green.
  OrderedJson metallic_roughness(const ImportedTexture* metallic, const ImportedTexture* roughness);
  /// A number: linear, the same in all channels.
  OrderedJson number(const ImportedTexture& texture);
  /// Vectors (normal maps): linear.
  OrderedJson vectors(const ImportedTexture& texture);

 private:
  enum class Use { color, number, vectors };
  OrderedJson info(const ImportedTexture& texture, const std::string& uri);
  std::string copied(const ImportedTexture& texture);
  std::string encoded(const ImportedTexture& texture, const std::string& key,
                      const LinearPicture& picture, const std::vector<std::uint8_t>& codes);
  /// Notes that `other` has the place of `placed` if the two differ.
  void note_place(const ImportedTexture& placed, const ImportedTexture& other,
                  const std::string& what);
  std::string unused_name(std::string stem, const std::string& kind);
  void note(const ImportedTexture& texture, std::string treatment, std::string how);

  GlbDocument& document_;
  std::filesystem::path folder_;
  std::vector<ImportNote>& notes_;
  std::map<std::string, std::string> uris_;      // by what the file holds
  std::map<std::string, double> scales_;         // of colours, by the same
  std::map<std::string, std::size_t> textures_;  // by uri and sampler
  std::set<std::string> names_, noted_;
};

}  // namespace lacuna
