#include "renderer/gltf/gltf_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/gltf_object.h"
#include "renderer/gltf/gltf_triangles.h"
#include "renderer/gltf/scene_folder.h"

namespace lacuna::gltf {
namespace {

template <class Is>
bool any_in(const GltfObject& root, std::string_view list, Is&& is) {
  return std::ranges::any_of(root.objects(list), is);
}
template <class Is>
bool any_primitive(const GltfObject& root, Is&& is) {
  return any_in(root, "meshes",
                [&](const GltfObject& mesh) { return any_in(mesh, "primitives", is); });
}
bool has_attribute(const GltfObject& root, std::string_view name) {
  return any_primitive(root, [&](const GltfObject& p) {
    const auto attributes = p.object("attributes");
    return attributes && attributes->has(name);
  });
}
bool has_alpha_mode(const GltfObject& root, const std::string& mode) {
  return any_in(root, "materials",
                [&](const GltfObject& m) { return m.string("alphaMode", "OPAQUE") == mode; });
}
bool has_camera(const GltfObject& root, const std::string& type) {
  return any_in(root, "cameras", [&](const GltfObject& c) { return c.string("type") == type; });
}
bool has_texture(const GltfObject& root, std::string_view key) {
  return any_in(root, "materials", [&](const GltfObject& m) { return m.has(key); });
}

using RootRef = const GltfObject&;

// The rows stand in the order of the page. Kept up by hand; tests hold extensions against it.
constexpr auto feature_rows = std::to_array<Feature>({
    {"triangles, strips, fans", Treatment::exact, "each primitive under each node is a mesh", "",
     [](RootRef r) {
       return any_primitive(r, [](const GltfObject& p) {
         return is_triangle_mode(static_cast<int>(p.integer("mode", 4, 0, 6)));
       });
     }},
    {"points, lines", Treatment::left_out, "they have no surface", "give them a radius as meshes",
     [](RootRef r) {
       return any_primitive(r, [](const GltfObject& p) {
         return !is_triangle_mode(static_cast<int>(p.integer("mode", 4, 0, 6)));
       });
     }},
    {"sparse accessors", Treatment::exact, "", "",
     [](RootRef r) {
       return any_in(r, "accessors", [](const GltfObject& a) { return a.has("sparse"); });
     }},
    {"skins", Treatment::exact, "in the pose of their joints", "",
     [](RootRef r) { return r.array_size("skins") > 0; }},
    {"morph targets", Treatment::exact, "at their weights", "",
     [](RootRef r) {
       return any_primitive(r, [](const GltfObject& p) { return p.has("targets"); });
     }},
    {"animations", Treatment::exact,
     "at the job's `time`; without it the static pose, with a warning", "",
     [](RootRef r) { return r.array_size("animations") > 0; }},
    {"metallic-roughness", Treatment::exact,
     "GGX with Schlick's term over a Lambertian base that conserves energy", "",
     [](RootRef r) { return r.array_size("materials") > 0; }},
    {"normal maps", Treatment::exact,
     "with the file's tangents; without them, tangents are those of each triangle's texture "
     "coordinates, where the specification asks for MikkTSpace, which averages them at vertices",
     "", [](RootRef r) { return has_texture(r, "normalTexture"); }},
    {"occlusion maps", Treatment::left_out, "occlusion is what is being computed", "",
     [](RootRef r) { return has_texture(r, "occlusionTexture"); }},
    {"emission", Treatment::exact, "radiance, which lights other surfaces", "",
     [](RootRef r) { return has_texture(r, "emissiveFactor"); }},
    {"COLOR_0", Treatment::exact, "multiplies base colour and alpha; white is not kept", "",
     [](RootRef r) { return has_attribute(r, "COLOR_0"); }},
    {"COLOR_1 and further", Treatment::left_out, "glTF gives them no meaning", "",
     [](RootRef r) { return has_attribute(r, "COLOR_1"); }},
    {"TEXCOORD_2 and further", Treatment::left_out, "a texture that reads them is refused", "",
     [](RootRef r) { return has_attribute(r, "TEXCOORD_2"); }},
    {"alphaMode MASK", Treatment::exact, "rays pass where alpha is below the cutoff", "",
     [](RootRef r) { return has_alpha_mode(r, "MASK"); }},
    {"alphaMode BLEND", Treatment::exact,
     "coverage: a ray passes with probability 1 - alpha, at each surface by itself; the analysis "
     "of the empty space takes the surface for a wall, as with MASK",
     "", [](RootRef r) { return has_alpha_mode(r, "BLEND"); }},
    {"doubleSided", Treatment::approximated,
     "only emission heeds it: all surfaces are seen and scatter on both sides", "",
     [](RootRef r) { return has_texture(r, "doubleSided"); }},
    {"textures", Treatment::exact,
     "PNG and JPEG, also TIFF of integers, bilinear; 16 bits are rounded to 8; magFilter NEAREST "
     "is read as LINEAR, and "
     "there are no mipmaps: pixels average many samples",
     "", [](RootRef r) { return r.array_size("textures") > 0; }},
    {"perspective cameras", Treatment::exact, "aspectRatio, znear and zfar are left out", "",
     [](RootRef r) { return has_camera(r, "perspective"); }},
    {"orthographic cameras", Treatment::exact,
     "height 2 ymag; the width follows from the resolution; what is behind the camera is not seen",
     "", [](RootRef r) { return has_camera(r, "orthographic"); }},
    {"KHR_lights_punctual", Treatment::exact,
     "in W/sr and W/m^2 (see light_units); `range` is left out", ""},
    {"EXT_lights_image_based", Treatment::approximated,
     "the faces of the largest mipmap, read as radiance (sRGB over alpha), become an "
     "equirectangular environment; the irradiance follows from them; the job's `environment` "
     "replaces it",
     ""},
    {"EXT_mesh_gpu_instancing", Treatment::exact,
     "TRANSLATION, ROTATION and SCALE; other attributes are left out", ""},
    {"EXT_meshopt_compression", Treatment::exact,
     "vertex codec 0, index codecs 0 and 1, with filters", ""},
    {"EXT_texture_webp", Treatment::exact, "still images", ""},
    {"KHR_materials_anisotropy", Treatment::exact, "tangents as for normal maps", ""},
    {"KHR_materials_clearcoat", Treatment::approximated,
     "what the coat lets through is reciprocal; one with a normal other than its base's is at "
     "least "
     "as rough as GGX of width 1e-4",
     ""},
    {"KHR_materials_diffuse_transmission", Treatment::exact, "", ""},
    {"KHR_materials_emissive_strength", Treatment::exact, "", ""},
    {"KHR_materials_ior", Treatment::exact, "", ""},
    {"KHR_materials_iridescence", Treatment::exact, "", ""},
    {"KHR_materials_pbrSpecularGlossiness", Treatment::approximated,
     "the diffuse part is weighted by what the specular layer lets through at each angle", ""},
    {"KHR_materials_sheen", Treatment::exact,
     "below roughness .5 bounded at grazing angles, where the formulas create energy", ""},
    {"KHR_materials_specular", Treatment::exact, "", ""},
    {"KHR_materials_transmission", Treatment::exact,
     "a thin wall; with KHR_materials_volume the surface of a solid", ""},
    {"KHR_materials_unlit", Treatment::exact,
     "emits its base colour and reflects nothing; it lights other surfaces and casts shadows", ""},
    {"KHR_materials_variants", Treatment::exact, "by the job's `variant`", ""},
    {"KHR_materials_volume", Treatment::exact,
     "absorption along the way inside; solids in solids are refracted as if air were between them",
     ""},
    {"KHR_draco_mesh_compression", Treatment::exact, "", ""},
    {"LACUNA_materials", Treatment::exact,
     "conductors, rough and thin dielectrics, plastics, Phong, Ward, coatings, mixtures, bump maps "
     "(docs/materials.md)",
     ""},
    {"KHR_mesh_quantization", Treatment::exact, "", ""},
    {"KHR_texture_transform", Treatment::exact, "", ""},
    {"KHR_node_visibility", Treatment::exact,
     "hides the meshes and lights at and below a node; cameras stay", ""},
    {"KHR_texture_basisu", Treatment::left_out, "the fallback image is read where there is one",
     "`gltf-transform ktxdecompress IN.glb OUT.glb` makes PNGs"},
    {"KHR_materials_dispersion", Treatment::left_out, "one index of refraction for all colours",
     ""},
    {"MSFT_texture_dds", Treatment::left_out, "the fallback image is read where there is one",
     "export with PNG or JPEG"},
    {"KHR_animation_pointer", Treatment::left_out, "", ""},
});

std::string_view name_of(Treatment t) {
  switch (t) {
    case Treatment::exact:
      return "exact";
    case Treatment::approximated:
      return "approximated";
    case Treatment::left_out:
      return "left out";
  }
  return "";
}

const Feature* find_extension(std::string_view extension) {
  const auto found = std::ranges::find_if(
      feature_rows, [&](const Feature& f) { return f.used_in == nullptr && f.name == extension; });
  return found == feature_rows.end() ? nullptr : &*found;
}

void add_extensions(const Json& value, std::set<std::string, std::less<>>& names) {
  if (value.is_array()) {
    for (const Json& element : value) add_extensions(element, names);
  }
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    if (key == "extras") continue;
    add_extensions(member, names);
    if (key != "extensions" || !member.is_object()) continue;
    for (const auto& [name, extension] : member.items()) names.insert(name);
  }
}

std::string text_of(const Feature& f) {
  return fmt::format("{}{}{}", f.how, f.how.empty() || f.remedy.empty() ? "" : "; ", f.remedy);
}

}  // namespace

std::span<const Feature> all_features() { return feature_rows; }

std::set<std::string, std::less<>> extensions_of(const Json& file) {
  std::set<std::string, std::less<>> names;
  add_extensions(file, names);
  if (const auto listed = file.find("extensionsUsed"); listed != file.end()) {
    for (const Json& name : *listed) names.insert(name.get<std::string>());
  }
  return names;
}

std::string remedy_for(std::string_view extension) {
  const Feature* const f = find_extension(extension);
  return f == nullptr || f->remedy.empty() ? "" : fmt::format("; {}", f->remedy);
}

std::string supported_extensions() {
  std::string names;
  for (const Feature& f : feature_rows) {
    if (f.used_in != nullptr || f.treatment == Treatment::left_out) continue;
    names.append(names.empty() ? "" : ", ").append(f.name);
  }
  return names;
}

bool extension_supported(std::string_view name) {
  const Feature* const f = find_extension(name);
  return f != nullptr && f->treatment != Treatment::left_out;
}

std::string unsupported_extension(std::string_view name) {
  return fmt::format("extension {} is not supported and left out", name);
}

}  // namespace lacuna::gltf

namespace lacuna {

std::vector<FeatureUse> features_of(const std::filesystem::path& file) {
  using namespace gltf;
  SceneFolder folder(file);
  const Bytes bytes = folder.read_main();
  const Framing framing = check_framing(bytes);
  const Json json = parse_json(framing.json);
  Warnings warnings;
  GltfProblems problems(json, warnings);
  const GltfObject root(json, problems);
  check_structure(root, framing);
  root.strings("extensionsUsed");  // are strings
  auto extensions = extensions_of(json);
  std::vector<FeatureUse> uses;
  for (const Feature& f : all_features()) {
    const bool used =
        f.used_in == nullptr ? extensions.erase(std::string(f.name)) > 0 : f.used_in(root);
    if (used) uses.push_back({std::string(f.name), std::string(name_of(f.treatment)), text_of(f)});
  }
  constexpr std::size_t most_unknown = 16;
  const std::size_t with_unknown = uses.size() + most_unknown;
  for (const std::string& unknown : extensions) {
    if (uses.size() == with_unknown) break;
    uses.push_back({unknown.substr(0, 100), "left out", ""});
  }
  return uses;
}

std::string feature_table() {
  std::string text = "| part of glTF | treatment | how |\n| --- | --- | --- |\n";
  for (const gltf::Feature& f : gltf::all_features()) {
    const std::string_view quote = f.used_in == nullptr ? "`" : "";
    text += fmt::format("| {0}{1}{0} | {2} | {3} |\n", quote, f.name, gltf::name_of(f.treatment),
                        gltf::text_of(f));
  }
  return text;
}

}  // namespace lacuna
