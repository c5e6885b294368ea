#include "jobs/import/pbrt/pbrt_textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/import/pbrt/pbrt_colours.h"

namespace lacuna::pbrt {
namespace {

/// What a Texture statement is read from.
struct TextureStatement {
  Context& context;
  const Parameters& parameters;
  bool is_float;

  std::optional<ImportedValue> find(const char* name) const {
    return is_float ? float_value(context, parameters, name)
                    : colour_value(context, parameters, name);
  }
  ImportedValue value(const char* name, float grey) const {
    return find(name).value_or(ImportedValue{Rgb(grey, grey, grey), nullptr});
  }
  void approximated(const std::string& how) const {
    context.approximated(parameters.place(), parameters.owner(), how);
  }
  /// A value without its texture, for patterns of patterns.
  Rgb plain(const ImportedValue& v) const {
    if (v.texture == nullptr) return v.value;
    approximated("a texture within it is replaced by its mean, taken as 0.5");
    return v.value * 0.5F;
  }
};

bool has_ending(const std::string& file, std::initializer_list<std::string_view> endings) {
  std::string lower = file;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view e) { return lower.ends_with(e); });
}

/// The mapping from the mesh's (u, v) to the pattern's.
void read_mapping(const TextureStatement& source, ImportedTexture& texture) {
  const Parameters& p = source.parameters;
  const std::string mapping = p.text("mapping", "uv");
  if (mapping != "uv") {
    source.approximated(
        fmt::format("mapping \"{}\" is replaced by the (u, v) of the mesh", mapping));
  }
  texture.scale = {p.number("uscale", p.number("su", 1)), p.number("vscale", p.number("sv", 1))};
  texture.offset = {p.number("udelta", p.number("du", 0)), p.number("vdelta", p.number("dv", 0))};
}

void read_wrap(const TextureStatement& source, ImportedTexture& texture) {
  const std::string wrap = source.parameters.text("wrap", "repeat");
  if (wrap == "black") source.approximated("outside of the picture: its border instead of black");
  if (wrap != "repeat") texture.wrap.fill(ImportedTexture::Wrap::clamp);
  if (wrap != "repeat" && wrap != "clamp" && wrap != "black") {
    fail(source.parameters.place(),
         fmt::format("wrap \"{}\"; allowed: repeat, clamp, black", wrap));
  }
}

/// pbrt-v4's `encoding`, pbrt-v3's `gamma`.
void read_encoding(const TextureStatement& source, ImportedTexture& texture) {
  const Parameters& p = source.parameters;
  const std::string encoding = p.text("encoding", "");
  if (encoding == "linear") {
    texture.srgb = false;
  } else if (encoding == "sRGB") {
    texture.srgb = true;
  } else if (encoding.starts_with("gamma ")) {
    const auto gamma = number_of(std::string_view(encoding).substr(6));
    if (!gamma || !(*gamma > 0)) {
      fail(p.place(),
           fmt::format("encoding \"{}\"; allowed: gamma and a number above 0", encoding));
    }
    texture.srgb = false;
    texture.gamma = *gamma;
  } else if (!encoding.empty()) {
    fail(p.place(), fmt::format("encoding \"{}\"; allowed: sRGB, linear, gamma X", encoding));
  }
  const Parameter* gamma = p.find("gamma", {"bool", "float"});
  if (gamma == nullptr) return;
  if (gamma->type == "bool") {
    texture.srgb = p.boolean("gamma", true);
  } else {
    texture.srgb = false;
    texture.gamma = p.number_in("gamma", 1, 0.01, 100);
  }
}

ImportedValue read_picture(const TextureStatement& source) {
  const Parameters& p = source.parameters;
  const Parameter* file = p.find("filename", {"string"});
  if (file == nullptr) fail(p.place(), fmt::format("{}: \"filename\" is missing", p.owner()));
  const float scale = static_cast<float>(p.number("scale", 1));
  const auto texture = picture(source.context, p, p.text("filename", ""));
  p.ignore({"maxanisotropy", "trilinear", "trilerp"});
  const std::string filter = p.text("filter", "bilinear");
  const bool invert = p.boolean("invert", false);
  if (texture == nullptr) {
    p.ignore({"encoding", "gamma", "wrap", "mapping", "uscale", "vscale", "udelta", "vdelta"});
    return {Rgb(0.5F, 0.5F, 0.5F) * scale, nullptr};
  }
  read_encoding(source, *texture);
  read_wrap(source, *texture);
  read_mapping(source, *texture);
  texture->nearest = filter == "point";
  texture->inverted = invert;
  return {Rgb(scale, scale, scale), texture};
}

ImportedValue read_checkerboard(const TextureStatement& source) {
  const ImportedValue first = source.value("tex1", 1), second = source.value("tex2", 0);
  source.parameters.ignore({"aamode"});
  const Rgb even = source.plain(first), odd = source.plain(second);
  if (source.parameters.integer("dimension", 2, 2, 3) == 3) {
    source.approximated("a pattern in space is replaced by its mean");
    return {(even + odd) * 0.5F, nullptr};
  }
  const auto texture = std::make_shared<ImportedTexture>();
  texture->place = source.parameters.place().text();
  read_mapping(source, *texture);
  // pbrt's squares have a side of 1, those of ImportedTexture 1/2.
  texture->scale *= 0.5;
  texture->offset *= 0.5;
  const float most = std::max(max_component(even), max_component(odd));
  if (!(most > 0)) return {Rgb(0, 0, 0), nullptr};
  const float unit = std::max(1.0F, most);  // what is baked lies in [0, 1]
  texture->even = even / unit;
  texture->odd = odd / unit;
  return {Rgb(unit, unit, unit), texture};
}

ImportedValue read_scale(const TextureStatement& source) {
  const bool v3 = source.context.is_v3();
  ImportedValue a = source.value(v3 ? "tex1" : "tex", 1);
  const char* second = v3 ? "tex2" : "scale";
  // The factor of pbrt-v4 is a float, also of a colour.
  auto b = source.find(second);
  if (!b) b = float_value(source.context, source.parameters, second);
  if (!b) return a;
  if (a.texture != nullptr && b->texture != nullptr) return {a.value * source.plain(*b), a.texture};
  return {a.value * b->value, a.texture != nullptr ? a.texture : b->texture};
}

ImportedValue read_mix(const TextureStatement& source) {
  const ImportedValue a = source.value("tex1", 0), b = source.value("tex2", 1);
  const auto amount = float_value(source.context, source.parameters, "amount");
  const float t = amount ? source.plain(*amount).x : 0.5F;
  if (t <= 0) return a;
  if (t >= 1) return b;
  if (a.texture == nullptr || b.texture == nullptr) {
    // A picture that is mixed with black is a scaled one.
    if (b.texture == nullptr && is_black(b.value)) return {a.value * (1 - t), a.texture};
    if (a.texture == nullptr && is_black(a.value)) return {b.value * t, b.texture};
  }
  return {source.plain(a) * (1 - t) + source.plain(b) * t, nullptr};
}

/// A pattern that is not kept: its mean.
ImportedValue read_other(const TextureStatement& source, const std::string& pattern) {
  const Parameters& p = source.parameters;
  Rgb mean(0.5F, 0.5F, 0.5F);
  if (pattern == "bilerp") {
    mean = (source.plain(source.value("v00", 0)) + source.plain(source.value("v01", 1)) +
            source.plain(source.value("v10", 0)) + source.plain(source.value("v11", 1))) *
           0.25F;
  } else if (pattern == "dots") {
    mean = source.plain(source.value("outside", 0));
    p.ignore({"inside"});
  } else if (pattern == "directionmix") {
    mean = (source.plain(source.value("tex1", 0)) + source.plain(source.value("tex2", 1))) * 0.5F;
  } else if (pattern != "fbm" && pattern != "wrinkled" && pattern != "windy" &&
             pattern != "marble" && pattern != "ptex" && pattern != "uv") {
    fail(p.place(),
         fmt::format(
             "texture \"{}\"; allowed: imagemap, constant, scale, mix, checkerboard, bilerp, "
             "dots, directionmix, fbm, wrinkled, windy, marble, ptex, uv",
             pattern));
  }
  p.ignore({"octaves", "roughness", "variation", "scale", "filename", "gamma", "encoding",
            "mapping", "uscale", "vscale", "udelta", "vdelta", "dir", "v1", "v2"});
  source.approximated(fmt::format("the pattern is replaced by one value, {:.3g} {:.3g} {:.3g}",
                                  mean.x, mean.y, mean.z));
  return {mean, nullptr};
}

}  // namespace

std::shared_ptr<ImportedTexture> picture(Context& context, const Parameters& parameters,
                                         const std::string& file) {
  const auto path = context.find_file(file, parameters.place(), parameters.owner());
  if (!path) return nullptr;
  auto texture = std::make_shared<ImportedTexture>();
  texture->place = parameters.place().text();
  texture->file = *path;
  texture->srgb = !has_ending(file, {".exr", ".hdr", ".pfm"});
  return texture;
}

void read_texture(Context& context, const std::string& name, const std::string& type,
                  const std::string& pattern, const Parameters& parameters) {
  const bool is_float = type == "float";
  if (!is_float && type != "spectrum" && type != "color") {
    fail(parameters.place(),
         fmt::format("texture of type \"{}\"; allowed: float, spectrum, color", type));
  }
  const TextureStatement source{context, parameters, is_float};
  const ImportedValue value = pattern == "imagemap"       ? read_picture(source)
                              : pattern == "constant"     ? source.value("value", 1)
                              : pattern == "scale"        ? read_scale(source)
                              : pattern == "mix"          ? read_mix(source)
                              : pattern == "checkerboard" ? read_checkerboard(source)
                                                          : read_other(source, pattern);
  Names& names = context.names;
  (is_float ? names.float_textures : names.spectrum_textures)[name] = value;
  context.note_unused(parameters);
}

std::optional<ImportedValue> float_value(const Context& context, const Parameters& parameters,
                                         const char* name) {
  if (const auto number = parameters.number(name)) {
    const float x = static_cast<float>(*number);
    return ImportedValue{Rgb(x, x, x), nullptr};
  }
  const Parameter* p = parameters.find(name, {"texture"});
  if (p == nullptr) return {};
  const auto& known = context.names.float_textures;
  const auto found = p->texts.size() == 1 ? known.find(p->texts[0]) : known.end();
  if (found != known.end()) return found->second;
  fail(p->place, fmt::format("{}: \"{}\" names no float texture defined before: \"{}\"",
                             parameters.owner(), name, p->texts.empty() ? "" : p->texts[0]));
}

std::optional<ImportedValue> colour_value(const Context& context, const Parameters& parameters,
                                          const char* name) {
  if (const Parameter* p = parameters.find_spectrum(name)) {
    return ImportedValue{reflected_colour(context, *p), nullptr};
  }
  const Parameter* p = parameters.find(name, {"texture"});
  if (p == nullptr) return {};
  const auto& known = context.names.spectrum_textures;
  const auto found = p->texts.size() == 1 ? known.find(p->texts[0]) : known.end();
  if (found != known.end()) return found->second;
  fail(p->place, fmt::format("{}: \"{}\" names no spectrum texture defined before: \"{}\"",
                             parameters.owner(), name, p->texts.empty() ? "" : p->texts[0]));
}

}  // namespace lacuna::pbrt
