#include "jobs/import/imported_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/storage/atomic_file.h"
#include "base/storage/input_file.h"
#include "renderer/core/scene_error.h"
#include "renderer/images/guards.h"
#include "renderer/images/png_write.h"

namespace lacuna {
namespace {

int wrap_code(ImportedTexture::Wrap wrap) {
  switch (wrap) {
    case ImportedTexture::Wrap::mirror:
      return 33648;
    case ImportedTexture::Wrap::clamp:
      return 33071;
    case ImportedTexture::Wrap::repeat:
      break;
  }
  return 10497;
}

/// What the texels of a texture are made from.
std::string key_of(const ImportedTexture& t) {
  if (t.file.empty()) {
    return fmt::format("checkerboard {} {} {} {} {} {}", t.even.x, t.even.y, t.even.z, t.odd.x,
                       t.odd.y, t.odd.z);
  }
  return fmt::format("{} {} {} {} {}", t.file.string(), t.srgb, t.gamma, t.channel.value_or(-1),
                     t.inverted);
}

std::string shown_name(const ImportedTexture& t) {
  return t.file.empty() ? "checkerboard" : fmt::format("texture {}", t.file.filename().string());
}

/// Whether glTF's readers take the file as it is.
bool is_plain_png_or_jpeg(const ImportedTexture& t) {
  if (t.channel || t.inverted) return false;
  std::string kind = t.file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind == ".png" || kind == ".jpg" || kind == ".jpeg";
}

LinearPicture grey(const LinearPicture& picture) {
  LinearPicture out = picture;
  for (Rgb& p : out.pixels) p = Rgb(luminance(p));
  return out;
}

LinearPicture white() { return {1, 1, {Rgb(1)}}; }

/// Gives both the larger size.
void fit(LinearPicture& a, LinearPicture& b) {
  const int width = std::max(a.width, b.width), height = std::max(a.height, b.height);
  for (LinearPicture* p : {&a, &b}) {
    if (p->width != width || p->height != height) *p = resized(*p, width, height);
  }
}

}  // namespace

void ImportedTextures::note(const ImportedTexture& t, std::string treatment, std::string how) {
  if (!noted_.insert(key_of(t) + how).second) return;
  notes_.push_back({t.place, shown_name(t), std::move(treatment), std::move(how)});
}

std::string ImportedTextures::unused_name(std::string stem, const std::string& kind) {
  for (char& c : stem) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  if (stem.size() > 100) stem.resize(100);
  std::string name = stem + kind;
  for (int i = 2; !names_.insert(name).second; ++i) name = fmt::format("{}-{}{}", stem, i, kind);
  return name;
}

OrderedJson ImportedTextures::info(const ImportedTexture& t, const std::string& uri) {
  if (t.nearest) {
    note(t, "approximated", "interpolated between texels, where the file asks for the nearest");
  }
  const int s = wrap_code(t.wrap[0]), u = wrap_code(t.wrap[1]);
  const std::string key = fmt::format("{} {} {}", uri, s, u);
  if (!textures_.contains(key)) {
    const std::size_t image = document_.add("images", {{"uri", uri}});
    const std::size_t sampler = document_.add("samplers", {{"wrapS", s}, {"wrapT", u}});
    textures_[key] = document_.add("textures", {{"source", image}, {"sampler", sampler}});
  }
  OrderedJson info = {{"index", textures_[key]}};
  if (t.scale != V2d(1, 1) || t.offset != V2d(0, 0)) {
    // glTF's v is 1 minus that of the description, of the mesh and of the picture.
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {t.offset.x, 1 - t.scale.y - t.offset.y}}, {"scale", {t.scale.x, t.scale.y}}};
  }
  return info;
}

std::string ImportedTextures::copied(const ImportedTexture& t) {
  const std::string key = "copy of " + t.file.string();
  if (const auto found = uris_.find(key); found != uris_.end()) return found->second;
  InputFile about;
  InputBytes bytes;
  try {
    bytes = read_input(t.file, max_encoded_bytes, about);
  } catch (const std::logic_error& e) {
    throw SceneError(fmt::format("{}: {}: {}", t.place, t.file.string(), e.what()));
  }
  const std::string name = unused_name(t.file.stem().string(), t.file.extension().string());
  std::filesystem::create_directories(folder_ / "textures");
  write_file_atomically(folder_ / "textures" / name,
                        {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, false);
  return uris_[key] = "textures/" + name;
}

std::string ImportedTextures::encoded(const ImportedTexture& t, const std::string& key,
                                      const LinearPicture& picture,
                                      const std::vector<std::uint8_t>& codes) {
  const std::string stem = t.file.empty() ? "checkerboard" : t.file.stem().string();
  const std::string name = unused_name(stem, ".png");
  std::filesystem::create_directories(folder_ / "textures");
  write_file_atomically(folder_ / "textures" / name,
                        encode_png(picture.width, picture.height, codes), false);
  return uris_[key] = "textures/" + name;
}

OrderedJson ImportedTextures::color(const ImportedTexture& t, double* scale) {
  if (scale != nullptr) *scale = 1;
  if (t.srgb && is_plain_png_or_jpeg(t)) return info(t, copied(t));
  const std::string key = fmt::format("{}color {}", scale != nullptr ? "scaled " : "", key_of(t));
  if (!uris_.contains(key)) {
    const LinearPicture picture = linear_picture(t);
    float largest = 0;
    for (const Rgb& p : picture.pixels) largest = std::max(largest, max_component(p));
    scales_[key] = scale != nullptr ? std::max(1.0, double(largest)) : 1.0;
    encoded(t, key, picture, srgb_codes(picture, scales_[key]));
    if (t.file.empty()) {
      note(t, "approximated", "baked at 512 x 512: its edges are interpolated over one texel");
    } else {
      note(t, "approximated",
           largest > 1 && scale == nullptr ? "rounded to 8 bits of sRGB; values above 1 become 1"
                                           : "rounded to 8 bits of sRGB");
    }
  }
  if (scale != nullptr) *scale = scales_[key];
  return info(t, uris_[key]);
}

OrderedJson ImportedTextures::color_with_alpha(const ImportedTexture* color,
                                               const ImportedValue& opacity) {
  const ImportedTexture* alpha = opacity.texture.get();
  const ImportedTexture& placed = color != nullptr ? *color : *alpha;
  const std::string key = fmt::format("alpha {} of {}", alpha == nullptr ? "1" : key_of(*alpha),
                                      color == nullptr ? "white" : key_of(*color));
  if (!uris_.contains(key)) {
    LinearPicture opacities = white(), colors = white();
    if (alpha != nullptr) opacities = grey(linear_picture(*alpha));
    if (color != nullptr) colors = linear_picture(*color);
    fit(opacities, colors);
    const auto rgb = srgb_codes(colors, 1), a = linear_codes(opacities);
    std::vector<std::uint8_t> rgba;
    rgba.reserve(4 * colors.pixels.size());
    for (std::size_t i = 0; i < colors.pixels.size(); ++i) {
      rgba.insert(rgba.end(), {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], a[3 * i]});
    }
    encoded(placed, key, colors, rgba);
    if (color != nullptr && alpha != nullptr) note_place(*color, *alpha, "colour");
  }
  return info(placed, uris_[key]);
}

void ImportedTextures::note_place(const ImportedTexture& placed, const ImportedTexture& other,
                                  const std::string& what) {
  const bool same =
      placed.scale == other.scale && placed.offset == other.offset && placed.wrap == other.wrap;
  if (same) return;
  note(other, "approximated",
       fmt::format("is placed as the {} of its material, whose transform differs", what));
}

OrderedJson ImportedTextures::metallic_roughness(const ImportedTexture* metallic,
                                                 const ImportedTexture* roughness) {
  const ImportedTexture& placed = roughness != nullptr ? *roughness : *metallic;
  const auto part = [](const ImportedTexture* t) { return t == nullptr ? "1" : key_of(*t); };
  const std::string key = fmt::format("metallic {} rough {}", part(metallic), part(roughness));
  if (!uris_.contains(key)) {
    LinearPicture blue = white(), green = white();
    if (metallic != nullptr) blue = grey(linear_picture(*metallic));
    if (roughness != nullptr) green = grey(linear_picture(*roughness));
    fit(blue, green);
    LinearPicture both = green;
    for (std::size_t i = 0; i < both.pixels.size(); ++i) {
      both.pixels[i] = {1, green.pixels[i].x, blue.pixels[i].x};
    }
    encoded(placed, key, both, linear_codes(both));
    if (metallic != nullptr && roughness != nullptr) note_place(placed, *metallic, "roughness");
  }
  return info(placed, uris_[key]);
}

OrderedJson ImportedTextures::number(const ImportedTexture& t) {
  const std::string key = "number " + key_of(t);
  if (!uris_.contains(key)) {
    const LinearPicture picture = grey(linear_picture(t));
    encoded(t, key, picture, linear_codes(picture));
    if (t.srgb || t.gamma != 1 || is_float_picture(t.file)) {
      note(t, "approximated", "rounded to 8 bits");
    }
  }
  return info(t, uris_[key]);
}

OrderedJson ImportedTextures::vectors(const ImportedTexture& t) {
  if (!t.srgb && t.gamma == 1 && is_plain_png_or_jpeg(t)) return info(t, copied(t));
  const std::string key = "vectors " + key_of(t);
  if (!uris_.contains(key)) {
    const LinearPicture picture = linear_picture(t);
    encoded(t, key, picture, linear_codes(picture));
    note(t, "approximated", "rounded to 8 bits");
  }
  return info(t, uris_[key]);
}

}  // namespace lacuna
