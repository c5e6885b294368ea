#include "jobs/import/mitsuba/textures.h"

#include <fmt/format.h>

#include <system_error>

#include "base/json/json_cursor.h"

namespace lacuna::mitsuba {
namespace {

constexpr int max_texture_depth = 16;

ImportedTexture::Wrap wrap_of(const SceneElement& at, const std::string& name) {
  if (name == "repeat") return ImportedTexture::Wrap::repeat;
  if (name == "mirror") return ImportedTexture::Wrap::mirror;
  if (name == "clamp") return ImportedTexture::Wrap::clamp;
  at.fail(fmt::format("has the wrap mode {}; allowed: repeat, mirror, clamp", in_quotes(name)));
}

/// uv of the picture = scale * uv + offset, with row 0 of the picture at v = 0: here v points up.
void place_uv(ReadContext& context, const Parameters& p, ImportedTexture& t) {
  const double both = p.number("uvscale", 1);
  V2d scale(p.number("uscale", both), p.number("vscale", both)),
      offset(p.number("uoffset", 0), p.number("voffset", 0));
  if (p.has("touv")) {
    const M44d m = p.transform("touv");
    scale = {scale.x * m[0][0], scale.y * m[1][1]};
    // A 3x3 matrix has its offset in the third row, a 4x4 one in the fourth.
    offset = {m[3][0] + m[2][0], m[3][1] + m[2][1]};
    if (m[0][1] != 0 || m[1][0] != 0) {
      context.note(p.element(), "approximated", "the rotation of its to_uv is left out");
    }
  }
  t.scale = scale;
  t.offset = {offset.x, 1 - scale.y - offset.y};
}

std::optional<int> channel_of(const SceneElement& at, const std::string& name) {
  if (name.empty()) return {};
  const std::string_view channels = "rgba";
  const auto index = name.size() == 1 ? channels.find(name[0]) : std::string_view::npos;
  if (index == std::string_view::npos) {
    at.fail(fmt::format("has the channel {}; allowed: r, g, b, a", in_quotes(name)));
  }
  return static_cast<int>(index);
}

}  // namespace

std::optional<std::filesystem::path> ReadContext::file(const SceneElement& at,
                                                       const std::string& name) {
  if (folder.empty()) at.fail("names a file; allowed: a scene without");
  if (name.empty()) at.fail("names no file");
  std::error_code error;
  bool within = false;
  for (const std::string& prefix : folders) {
    const auto path = find_within(folder, prefix + name);
    within |= path.has_value();
    if (path && std::filesystem::is_regular_file(*path, error)) return path;
  }
  missing_files.push_back(
      fmt::format("{}: {} {}", at.place, name,
                  within ? "does not exist" : "lies outside of the folder of the scene"));
  return {};
}

TexturedValue Textures::value(const Parameters& of, std::string_view name, const Rgb& fallback) {
  if (!of.has(name)) return {{fallback, nullptr}, false};
  if (const auto color = of.color(name)) return {{*color, nullptr}, false};
  const SceneElement* object = of.object(name);
  if (object->tag != "texture") {
    object->fail(fmt::format("stands for {} of {}; allowed: a colour or a texture", in_quotes(name),
                             of.element().label()));
  }
  return texture(*object);
}

TexturedValue Textures::texture(const SceneElement& element) {
  if (const auto found = known_.find(&element); found != known_.end()) return found->second;
  if (++depth_ > max_texture_depth) element.fail("is nested more than 16 textures deep");
  TexturedValue read_value = read(element);
  --depth_;
  return known_[&element] = std::move(read_value);
}

TexturedValue Textures::read(const SceneElement& element) {
  const std::string& type = element.type();
  if (type == "bitmap" || type == "ldrtexture" || type == "exrtexture") {
    return read_bitmap(element);
  }
  if (type == "checkerboard") return read_checkerboard(element);
  if (type == "scale") return read_scale(element);
  const Parameters p = context_.parameters(element);
  if (type == "vertexcolors" ||
      (type == "mesh_attribute" && p.text("name", "vertex_color") == "vertex_color")) {
    const auto scale = static_cast<float>(p.number("scale", 1));
    p.note_unread(context_.notes);
    return {{Rgb(scale), nullptr}, true};
  }
  return {{mean_of(p), nullptr}, false};
}

Rgb Textures::mean_of(const Parameters& p) {
  Rgb sum(0);
  int colours = 0;
  for (const SceneElement& child : p.element().children) {
    if (child.tag != "rgb" && child.tag != "srgb" && child.tag != "spectrum") continue;
    if (const auto colour = color_of(child)) sum += *colour, ++colours;
  }
  const Rgb mean = colours == 0 ? Rgb(.5F) : sum / static_cast<float>(colours);
  context_.note(p.element(), "approximated",
                fmt::format("its mean colour, taken as {:.3g} {:.3g} {:.3g}; textures that are "
                            "read: bitmap, checkerboard, scale, vertexcolors, mesh_attribute of "
                            "vertex_color",
                            mean.x, mean.y, mean.z));
  p.ignore_all();
  return mean;
}

TexturedValue Textures::read_bitmap(const SceneElement& element) {
  const Parameters p = context_.parameters(element);
  ImportedTexture t;
  t.place = element.place;
  const std::string name = p.text("filename", "");
  const auto file = context_.file(element, name);
  const double gamma = p.number("gamma", p.number("srgb", -1));
  const bool raw = p.boolean("raw", false);
  t.srgb = gamma <= 0 && !raw;
  if (gamma > 0) t.gamma = gamma;
  t.channel = channel_of(element, p.text("channel", ""));
  const std::string wrap = p.text("wrapmode", "repeat");
  t.wrap = {wrap_of(element, p.text("wrapmodeu", wrap)),
            wrap_of(element, p.text("wrapmodev", wrap))};
  t.nearest = p.text("filtertype", "") == "nearest";
  place_uv(context_, p, t);
  p.ignore({"maxanisotropy", "cache", "accel", "format"});
  p.note_unread(context_.notes);
  if (!file) {
    context_.note(element, "left out",
                  fmt::format("{} is missing: grey .5 stands for it", in_quotes(name)));
    return {{Rgb(.5F), nullptr}, false};
  }
  t.file = *file;
  return {{Rgb(1), std::make_shared<const ImportedTexture>(std::move(t))}, false};
}

TexturedValue Textures::read_checkerboard(const SceneElement& element) {
  const Parameters p = context_.parameters(element);
  ImportedTexture t;
  t.place = element.place;
  // Cells count from v = 0, at the top here: the colours change places.
  t.odd = p.color("color0").value_or(Rgb(.4F));
  t.even = p.color("color1").value_or(Rgb(.2F));
  place_uv(context_, p, t);
  p.note_unread(context_.notes);
  return {{Rgb(1), std::make_shared<const ImportedTexture>(std::move(t))}, false};
}

TexturedValue Textures::read_scale(const SceneElement& element) {
  const Parameters p = context_.parameters(element);
  const auto scale = p.color("scale").value_or(p.color("value").value_or(Rgb(1)));
  const auto inner = p.objects("texture");
  if (inner.size() != 1) element.fail("has no texture in it; required: one");
  TexturedValue value = texture(*inner[0]);
  for (int c = 0; c < 3; ++c) value.value.value[c] *= scale[c];
  p.note_unread(context_.notes);
  return value;
}

}  // namespace lacuna::mitsuba
