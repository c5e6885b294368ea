#include "renderer/gltf/gltf_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "renderer/core/huge_pages.h"

namespace lacuna::gltf {
namespace {

/// Whether facets, those of the parts too, have two widths, along and across a tangent.
bool two_widths(const LacunaMaterial& l) {
  return l.alpha.x != l.alpha.y ||
         std::ranges::any_of(l.parts, [](const LacunaMaterial::Part& part) {
           const Material& m = *part.material;
           return m.lacuna ? two_widths(*m.lacuna) : m.extensions.anisotropy.strength > 0;
         });
}

/// Which of TEXCOORD_0 and _1 the material's textures read, or the direction of its facets.
std::array<bool, 2> uv_sets_used(const Material& m) {
  std::array<bool, 2> used{};
  const auto use = [&](const TextureRef& ref) {
    if (ref.used()) used[static_cast<std::size_t>(ref.uv_set)] = true;
  };
  m.for_each_scattering_texture(use);
  use(m.emission_texture);
  use(m.normal_texture);
  if (m.lacuna) {
    use(m.lacuna->bump);
    if (two_widths(*m.lacuna)) {
      used[static_cast<std::size_t>(m.lacuna->alpha_texture.uv_set)] = true;
    }
  }
  if (const Anisotropy& a = m.extensions.anisotropy; a.strength > 0) {
    used[static_cast<std::size_t>(a.texture.uv_set)] = true;
  }
  return used;
}

void read_uvs(const Source& source, const std::vector<std::uint32_t>& kept,
              const Material& material, Mesh& mesh, Warnings& warnings) {
  const auto used = uv_sets_used(material);
  for (std::size_t set = 0; set < used.size(); ++set) {
    if (!used[set]) continue;
    const std::string name = "TEXCOORD_" + std::to_string(set);
    if (source.attribute(name) < 0) {
      warnings.once(source.place() + " has no " + name + ", which material \"" + material.name +
                    "\" needs: its textures are read at (0, 0)");
      continue;
    }
    const AccessorView view = source.view(name, ElementType::vec2, Components::quantized);
    reserve_huge(mesh.uvs[set], kept.size());
    for (const std::uint32_t v : kept) {
      const auto uv = view.floats<2>(v);
      mesh.uvs[set].emplace_back(uv[0], uv[1]);
    }
  }
}

/// With a normal map, or facets of two widths. glTF 2.0, section 3.7.2.1: tangents count only with
/// normals.
void read_tangents(const Source& source, const Vertices& vertices,
                   const std::vector<std::uint32_t>& kept, Mesh& mesh, Warnings& warnings) {
  if (source.attribute("TANGENT") < 0 || mesh.normals.empty()) return;
  const AccessorView view = source.view("TANGENT", ElementType::vec4, Components::normalized);
  const MorphTargets targets(source, "TANGENT");
  std::vector<V4f> out;
  out.reserve(kept.size());
  for (const std::uint32_t v : kept) {
    const auto t = view.floats<4>(v);
    const V4f tangent =
        vertices.world_tangent(v, targets.add_to({t[0], t[1], t[2]}, v), t[3] < 0 ? -1.0F : 1.0F);
    if (tangent.x == 0 && tangent.y == 0 && tangent.z == 0) {
      warnings.first_of("tangents", source.place() + ": TANGENT of vertex " + std::to_string(v) +
                                        " has no direction; the tangents are computed from the "
                                        "texture coordinates");
      return;
    }
    out.push_back(tangent);
  }
  mesh.tangents = std::move(out);
}

/// A component of a colour. Throws SceneError for what is no number.
float color_component(float value, const Source& source, std::uint32_t vertex, Warnings& warnings) {
  const auto found = [&] {
    return source.place() + ": COLOR_0 of vertex " + std::to_string(vertex) + " has " +
           std::to_string(value) + "; allowed: 0 to 1";
  };
  if (!std::isfinite(value)) throw SceneError(found());
  if (value < 0 || value > 1) warnings.first_of("colours", found() + "; clamped");
  return std::clamp(value, 0.0F, 1.0F);
}

void read_colors(const Source& source, const std::vector<std::uint32_t>& kept, Mesh& mesh,
                 Warnings& warnings) {
  const int accessor = source.attribute("COLOR_0");
  if (accessor < 0) return;
  const bool has_alpha =
      source.model.accessors[static_cast<std::size_t>(accessor)].type == ElementType::vec4;
  const AccessorView view = source.view(
      "COLOR_0", has_alpha ? ElementType::vec4 : ElementType::vec3, Components::normalized);
  std::vector<V4f> out;
  out.reserve(kept.size());
  for (const std::uint32_t v : kept) {
    std::array<float, 4> c{0, 0, 0, 1};
    if (has_alpha) {
      c = view.floats<4>(v);
    } else {
      const auto rgb = view.floats<3>(v);
      std::copy(rgb.begin(), rgb.end(), c.begin());
    }
    for (float& x : c) x = color_component(x, source, v, warnings);
    out.emplace_back(c[0], c[1], c[2], c[3]);
  }
  const V4f white(1, 1, 1, 1);
  if (std::ranges::any_of(out, [&](const V4f& c) { return c != white; })) {
    mesh.colors = std::move(out);
  }
}

}  // namespace

void read_attributes(const Source& source, const Vertices& vertices,
                     const std::vector<std::uint32_t>& kept, const Material& material, Mesh& mesh,
                     Warnings& warnings) {
  read_uvs(source, kept, material, mesh, warnings);
  const bool turned = material.normal_texture.used() ||
                      material.extensions.anisotropy.strength > 0 ||
                      (material.lacuna && two_widths(*material.lacuna));
  if (turned) read_tangents(source, vertices, kept, mesh, warnings);
  read_colors(source, kept, mesh, warnings);
}

}  // namespace lacuna::gltf
