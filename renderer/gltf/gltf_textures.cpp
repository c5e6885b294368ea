#include "renderer/gltf/gltf_textures.h"

#include "renderer/gltf/gltf_features.h"

#include <algorithm>
#include <string>

namespace lacuna::gltf {
namespace {

Texture::Wrap wrap_mode(const GltfObject* sampler, const char* key) {
  constexpr std::uint64_t repeat = 10497;
  switch (sampler == nullptr ? repeat : sampler->integer(key, repeat, 0, 65535)) {
    case 33071:
      return Texture::Wrap::clamp;
    case 33648:
      return Texture::Wrap::mirrored;
    default:
      return Texture::Wrap::repeat;
  }
}

V2f to_v2f(const std::array<double, 2>& a) {
  return {static_cast<float>(a[0]), static_cast<float>(a[1])};
}

constexpr std::uint64_t last_uv_set = 1;

Bytes encoded_bytes(const GltfObject& image, const file::Model& model, SceneFolder& folder) {
  if (const auto view = image.index("bufferView", model.views.size(), "bufferViews")) {
    const auto* first = model.bytes_of(*view);
    return {first, first + model.views[*view].bytes};
  }
  const std::string uri = image.string("uri");
  if (uri.starts_with("data:")) return decode_data_uri(image, uri);
  return folder.read(uri, image.label(), InputRole::texture);
}

}  // namespace

TextureTable::TextureTable(const GltfObject& root, Warnings& warnings)
    : warnings_(warnings),
      textures_(root.objects("textures")),
      images_(root.objects("images")),
      samplers_(root.objects("samplers")) {}

TextureRef TextureTable::reference(const GltfObject& owner, std::string_view key,
                                   Texture::Encoding encoding, bool needed) {
  TextureRef ref;
  const auto info = owner.object(key);
  if (!info) return ref;
  const auto index = info->index("index", textures_.size(), "textures");
  if (!index) info->fail("index is missing");
  ref.uv_set = static_cast<int>(info->integer("texCoord", 0, 0, last_uv_set));
  if (const auto transform = info->extension("KHR_texture_transform")) {
    if (const auto offset = transform->numbers<2>("offset", any_float))
      ref.offset = to_v2f(*offset);
    if (const auto scale = transform->numbers<2>("scale", any_float)) ref.scale = to_v2f(*scale);
    ref.rotation = static_cast<float>(transform->number("rotation", 0, any_float));
    ref.uv_set = static_cast<int>(
        transform->integer("texCoord", static_cast<std::uint64_t>(ref.uv_set), 0, last_uv_set));
  }
  if (needed) ref.texture = enter(textures_[*index], encoding);
  return ref;
}

std::size_t TextureTable::source_of(const GltfObject& texture) const {
  if (const auto webp = texture.extension("EXT_texture_webp")) {
    if (const auto source = webp->index("source", images_.size(), "images")) return *source;
  }
  if (const auto source = texture.index("source", images_.size(), "images")) return *source;
  const auto extensions = texture.object("extensions");
  const auto names = extensions ? extensions->keys() : std::vector<std::string>{};
  texture.fail("source is missing: it has no PNG or JPEG image" +
               (names.empty() ? ""
                              : ", only what extension " + names.front() + " gives" +
                                    remedy_for(names.front())));
}

int TextureTable::enter(const GltfObject& texture, Texture::Encoding encoding) {
  const auto source = source_of(texture);
  const auto sampler = texture.index("sampler", samplers_.size(), "samplers");
  const GltfObject* used = sampler ? &samplers_[*sampler] : nullptr;
  constexpr std::uint64_t nearest = 9728;
  if (used != nullptr && used->has("magFilter") &&
      used->integer("magFilter", 0, 65535) == nearest) {
    warnings_.once("samplers with magFilter NEAREST are read with bilinear interpolation");
  }
  return enter({source, encoding, wrap_mode(used, "wrapS"), wrap_mode(used, "wrapT")});
}

int TextureTable::enter(const Entry& entry) {
  const auto found = std::find(entries_.begin(), entries_.end(), entry);
  const auto index = found - entries_.begin();
  if (found == entries_.end()) entries_.push_back(entry);
  return static_cast<int>(index);
}

std::vector<std::unique_ptr<Texture>> TextureTable::build(const file::Model& model,
                                                          SceneFolder& folder, Hasher& content,
                                                          std::uint64_t most_bytes) const {
  std::vector<std::unique_ptr<Texture>> built;
  std::vector<bool> hashed(images_.size());
  std::uint64_t all_bytes = 0;
  for (const Entry& entry : entries_) {
    const GltfObject& image = images_[entry.image];
    Bytes bytes = encoded_bytes(image, model, folder);
    all_bytes += bytes.size();
    if (all_bytes > most_bytes) {
      image.fail("is one too many: the textures have more than " + std::to_string(most_bytes) +
                 " bytes together, each way of reading counted");
    }
    if (!hashed[entry.image]) content.add(std::span<const std::uint8_t>(bytes));
    hashed[entry.image] = true;
    built.push_back(std::make_unique<Texture>(image.label(), std::move(bytes), entry.encoding,
                                              entry.wrap_s, entry.wrap_t));
  }
  return built;
}

}  // namespace lacuna::gltf
