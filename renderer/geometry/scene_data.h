#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/core/bounds.h"
#include "renderer/core/scene_error.h"
#include "renderer/core/vec.h"
#include "renderer/geometry/instance.h"
#include "renderer/geometry/lacuna_material.h"
#include "renderer/geometry/material_extensions.h"
#include "renderer/images/texture.h"
#include "renderer/settings/camera_settings.h"

namespace lacuna {

/// Triangles of one material under one node, in scene coordinates, or in those of a prototype.
struct Mesh {
  std::string name;
  std::vector<V3f> positions;
  std::vector<V3f> normals;             ///< unit shading normals, one per position; empty: flat
  std::array<std::vector<V2f>, 2> uvs;  ///< TEXCOORD_0 and _1; each empty or one per position
  /// TANGENT: a unit vector along +u, and in w the sign of the bitangent; empty, or one per
  /// position.
  std::vector<V4f> tangents;
  /// COLOR_0: linear RGB and alpha, which multiply the base colour; empty, or one per position.
  std::vector<V4f> colors;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices below positions.size()
  std::uint32_t material = 0;

  /// Both texture coordinates at barycentric (u, v) of a triangle; (0, 0) if the mesh has none.
  std::array<V2f, 2> uvs_at(std::uint32_t triangle, float u, float v) const {
    std::array<V2f, 2> result{V2f(0, 0), V2f(0, 0)};
    const auto& t = triangles[triangle];
    for (std::size_t set = 0; set < 2; ++set) {
      if (uvs[set].empty()) continue;
      result[set] = (1 - u - v) * uvs[set][t[0]] + u * uvs[set][t[1]] + v * uvs[set][t[2]];
    }
    return result;
  }
  /// The mean of values of the corners of a triangle at barycentric (u, v).
  template <class T>
  T mix(const std::vector<T>& of_corners, std::uint32_t triangle, const V2f& at) const {
    const auto& t = triangles[triangle];
    return of_corners[t[0]] * (1 - at.x - at.y) + of_corners[t[1]] * at.x + of_corners[t[2]] * at.y;
  }
};

/// glTF 2.0 metallic-roughness with KHR_materials_emissive_strength, _ior, _specular,
/// _transmission and those of MaterialExtensions. Factors are linear and multiply their texture.
struct Material {
  std::string name;
  Rgb base_color{1, 1, 1};
  float alpha = 1;
  TextureRef base_color_texture;  ///< sRGB; its A channel is the alpha
  float metallic = 1;
  float roughness = 1;                    ///< perceptual: GGX alpha is its square
  TextureRef metallic_roughness_texture;  ///< linear; G roughness, B metallic
  Rgb emission{0, 0, 0};                  ///< radiance: emissiveFactor x emissiveStrength
  TextureRef emission_texture;            ///< sRGB
  float ior = 1.5F;                       ///< 0 means F0 = 1 (KHR_materials_ior)
  float specular = 1;
  TextureRef specular_texture;  ///< A
  Rgb specular_color{1, 1, 1};
  TextureRef specular_color_texture;  ///< sRGB
  float transmission = 0;
  TextureRef transmission_texture;  ///< R
  MaterialExtensions extensions;
  std::optional<LacunaMaterial> lacuna;  ///< LACUNA_materials, instead of all but the base colour
  TextureRef normal_texture;             ///< linear; RGB is the normal, from [0, 1] to [-1, 1]
  float normal_scale = 1;                ///< of the normal's x and y
  bool mask = false;                     ///< alphaMode MASK: rays pass where alpha < cutoff
  bool blend = false;                    ///< alphaMode BLEND: rays pass with probability 1 - alpha
  /// KHR_materials_pbrSpecularGlossiness: A of specular_color_texture times 1 - roughness is the
  /// glossiness, 1 minus the roughness there.
  bool textured_glossiness = false;
  bool unlit = false;          ///< KHR_materials_unlit: emits its base colour, black otherwise
  bool vertex_colors = false;  ///< its meshes have colours, and no others use it
  float alpha_cutoff = 0.5F;
  bool double_sided = false;  ///< emits from both sides; all surfaces scatter on both

  bool emits() const { return !is_black(emission); }
  /// Light behind the surface, whatever absorbs there, comes from other surfaces only.
  bool emits_behind() const { return emits() && double_sided && medium() == nullptr; }
  /// The absorbing medium behind the surface; null: there is none.
  const Medium* medium() const {
    const bool passes = transmission > 0 || extensions.diffuse_transmission.factor > 0 ||
                        (lacuna && lacuna->transmits());
    const Volume& v = extensions.volume;
    return passes && v.solid && !is_black(v.inside.extinction) ? &v.inside : nullptr;
  }
  /// Whether nothing of it is seen: alphaMode BLEND with an alpha of 0.
  bool invisible() const { return blend && alpha == 0; }
  /// Whether vertex colours multiply the emission, too: it is the colour of KHR_materials_unlit.
  bool emits_vertex_colors() const { return unlit && vertex_colors; }
  bool operator==(const Material&) const = default;

  /// Calls `f` with each texture that the lobes of scattering depend on; not the normal map, which
  /// turns them.
  template <class F>
  void for_each_scattering_texture(F&& f) const {
    for (const TextureRef* t : {&base_color_texture, &metallic_roughness_texture, &specular_texture,
                                &specular_color_texture, &transmission_texture}) {
      if (t->used()) f(*t);
    }
    extensions.for_each_texture(f);
    if (lacuna) lacuna->for_each_texture(f);
  }
  /// Whether the lobes differ from point to point of a surface.
  bool varies() const {
    bool result = vertex_colors || extensions.coat.own_normal || (lacuna && lacuna->chooses());
    for_each_scattering_texture([&](const TextureRef&) { result = true; });
    return result;
  }
};

template <class F>
void LacunaMaterial::for_each_texture(F&& f) const {
  for (const TextureRef* t : {&alpha_texture, &reflectance_texture, &weight_texture}) {
    if (t->used()) f(*t);
  }
  for (const Part& part : parts) part.material->for_each_scattering_texture(f);
}

/// A camera. Looks along -z of `to_world`, x right, y up.
struct CameraData {
  std::string name = {};
  M44d to_world =
      {};  ///< Imath convention: row vectors, p_world = p * to_world; orthonormal 3x3 part
  double yfov = 0.8;      ///< perspective: vertical field of view, radians, in (0, pi)
  std::string node = {};  ///< name of the camera's node
  Projection projection = Projection::perspective;
  double height = 2;    ///< orthographic: of the film, scene units
  double aperture = 0;  ///< perspective: radius of the lens, scene units; 0: a pinhole
  double focus = 1;     ///< distance of the sharp plane along the view, scene units, above 0
  int blades = 0;       ///< corners of the aperture, at least 3; 0: it is round
};

struct SurfaceContact;

/// A light of KHR_lights_punctual. `intensity` is read 1:1 as W/sr (point, spot) or W/m^2
/// (directional).
struct PunctualLight {
  enum class Kind { point, spot, directional };
  Kind kind = Kind::point;
  std::string name;
  Rgb intensity{1, 1, 1};  ///< colour x intensity
  V3f position{0, 0, 0};
  V3f direction{0, 0, -1};  ///< unit, the direction of the light's travel
  float inner_cone = 0;     ///< radians, half angle; 0 <= inner <= outer, 0 < outer <= pi/2
  float outer_cone = 0.785398F;
  /// Point and spot lights of a Scene: the surfaces that contain the light; null if there are none.
  std::shared_ptr<const SurfaceContact> contact;
};

/// The environment light of EXT_lights_image_based: a cube map of radiance around the scene.
struct EnvironmentCube {
  /// Textures, sRGB: towards +x, -x, +y, -y, +z, -z of the cube, as seen from inside. Their colours
  /// over their alpha are the radiance (RGBD).
  std::array<int, 6> faces{};
  int side = 0;  ///< texels that each face should have along an edge
  float intensity = 1;
  M44d to_world = {};  ///< row vectors: w_world = w_cube * to_world; a rotation
};

/// The contents of a glTF file that Lacuna uses, validated: indices in range, coordinates and
/// factors finite and within glTF's ranges, no degenerate triangles. Textures are not decoded yet.
struct SceneData {
  /// First those in scene coordinates, then those of the prototypes, in the prototypes'
  /// coordinates. The latter do not emit.
  std::vector<Mesh> meshes;
  std::vector<Prototype> prototypes;
  std::vector<Instance> instances;
  /// Those of the file, glTF's default material, and copies for meshes with vertex colours.
  std::vector<Material> materials;
  std::vector<std::unique_ptr<Texture>> textures;
  std::vector<CameraData> cameras;
  std::vector<PunctualLight> lights;
  std::optional<EnvironmentCube> environment;

  /// Scene coordinates are the file's coordinates minus `origin`. 0 unless the scene lies far from
  /// the file's origin (gltf_origin.h). All computations, warnings and stored data use scene
  /// coordinates.
  V3d origin{0, 0, 0};
  std::uint64_t content_hash = 0;       ///< of all bytes read: the file, its buffers and its images
  std::uint64_t geometry_hash = 0;      ///< of positions, indices and instances only
  std::uint64_t dropped_triangles = 0;  ///< zero area or non-finite vertices
  std::vector<std::string> warnings;    ///< ignored parts of the file

  /// The meshes in scene coordinates.
  std::span<const Mesh> placed_meshes() const {
    return std::span(meshes).first(prototypes.empty() ? meshes.size() : prototypes[0].first_mesh);
  }
  std::span<const Mesh> meshes_of(const Prototype& p) const {
    return std::span(meshes).subspan(p.first_mesh, p.mesh_count);
  }
  /// Sets Instance::ray_error of all instances, which are complete.
  void bound_ray_errors();
  std::size_t stored_triangles() const;  ///< those of prototypes once
  std::size_t triangle_count() const;    ///< those of prototypes once for each instance
  /// A box of all triangles, scene units; around instances not always the smallest.
  Bounds bounds() const;
};

/// The box of all triangles, in the coordinates of the meshes.
Bounds bounds_of(std::span<const Mesh> meshes);

}  // namespace lacuna
