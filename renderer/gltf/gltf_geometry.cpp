#include "renderer/gltf/gltf_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "renderer/gltf/gltf_duplicates.h"
#include "renderer/gltf/gltf_limits.h"
#include "renderer/gltf/gltf_origin.h"
#include "renderer/gltf/gltf_primitives.h"
#include "renderer/gltf/gltf_vertices.h"

namespace lacuna::gltf {
namespace {

constexpr std::size_t max_triangles = std::size_t{1} << 27;
constexpr std::size_t max_moves = std::size_t{1} << 27;

struct Counts {
  Dropped dropped;
  std::uint64_t normals = 0;
  std::uint64_t coarse = 0;                                  ///< meshes; see warn_of_places()
  std::uint64_t points_and_lines = 0, without_position = 0;  ///< primitives
  std::uint64_t hidden = 0;  ///< nodes with a mesh and a scale that leaves nothing of it
};

/// Positions relative to `origin`. A vertex that is not finite in the file stays so: its triangles
/// are dropped.
std::vector<V3f> world_positions(const Source& source, const Vertices& vertices,
                                 const std::vector<std::uint32_t>& kept, const V3d& origin) {
  std::vector<V3f> out(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const V3d world = vertices.world(kept[i]);
    for (int k = 0; k < 3; ++k) {
      if (std::abs(world[k]) <= max_coordinate) continue;
      if (!vertices.finite(kept[i])) break;  // then world - origin is not finite
      throw SceneError(source.place() + ": vertex " + std::to_string(kept[i]) + " lies at " +
                       std::to_string(world[k]) + "; allowed: " + coordinate_rule);
    }
    out[i] = V3f(world - origin);
  }
  return out;
}

Bounds bounds_of(const Vertices& vertices, const std::vector<std::uint32_t>& kept) {
  Bounds box;
  for (const std::uint32_t v : kept) {
    if (const V3f x(vertices.local(v)); is_finite(x)) box.add(x);
  }
  return box;
}

std::vector<V3f> world_normals(const Vertices& vertices, const std::vector<std::uint32_t>& kept) {
  std::vector<V3f> out(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) out[i] = vertices.world_normal(kept[i]);
  return out;
}

/// Gives every vertex without a usable normal the geometric one of the first triangle that uses it.
std::uint64_t mend_normals(Mesh& mesh) {
  std::uint64_t mended = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (mesh.normals[v] != V3f(0, 0, 0)) continue;
      const V3d a(mesh.positions[t[0]]);
      const V3d ng = (V3d(mesh.positions[t[1]]) - a).cross(V3d(mesh.positions[t[2]]) - a);
      mesh.normals[v] = V3f(ng.normalized());
      ++mended;
    }
  }
  return mended;
}

/// Which of TEXCOORD_0 and _1 the material's textures read.
std::array<bool, 2> uv_sets_used(const Material& m) {
  std::array<bool, 2> used{};
  for (const TextureRef* ref :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.emission_texture,
        &m.specular_texture, &m.specular_color_texture, &m.transmission_texture}) {
    if (ref->used()) used[static_cast<std::size_t>(ref->uv_set)] = true;
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
    mesh.uvs[set].reserve(kept.size());
    for (const std::uint32_t v : kept) {
      const auto uv = view.floats<2>(v);
      mesh.uvs[set].emplace_back(uv[0], uv[1]);
    }
  }
}

bool is_read(const std::string& attribute) {
  return attribute == "POSITION" || attribute == "NORMAL" || attribute == "TEXCOORD_0" ||
         attribute == "TEXCOORD_1";
}

void warn_of_vertices(const Source& source, const Vertices& vertices, Warnings& warnings) {
  for (const auto& [name, accessor] : source.primitive().attributes) {
    const bool of_a_skin = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
    if (!is_read(name) && !of_a_skin) warnings.once("vertex attribute " + name + " is left out");
  }
  const std::size_t targets = source.primitive().targets.size();
  if (const std::size_t weights = source.node.weights.size(); weights != targets && weights > 0) {
    warnings.first_of("weights", source.place() + ": " + std::to_string(weights) + " weights for " +
                                     std::to_string(targets) +
                                     " morph targets; those without a weight are left out");
  }
  if (source.node.skin && !source.skinned()) {
    warnings.first_of("unskinned", source.place() +
                                       ": JOINTS_0 or WEIGHTS_0 is missing: its node places it, "
                                       "and not its skin");
  }
  if (const SkinWeights* skin = vertices.skin(); skin != nullptr && skin->without_weights() > 0) {
    warnings.first_of("weightless", source.place() + ": " +
                                        std::to_string(skin->without_weights()) +
                                        " vertices have no weights: the skin's first joint "
                                        "carries them");
  }
}

Mesh build_mesh(const Source& source, const SceneData& scene, Counts& counts, Warnings& warnings) {
  Mesh mesh;
  mesh.material = source.primitive().material >= 0
                      ? static_cast<std::uint32_t>(source.primitive().material)
                      : static_cast<std::uint32_t>(scene.materials.size() - 1);
  const Vertices vertices(source);
  mesh.triangles = assemble_triangles(source.model, source.primitive(), vertices.size(),
                                      vertices.mirrored(), source.place());
  if (const auto spare = spare_corners(source.model, source.primitive()); spare > 0) {
    warnings.first_of("corners", source.place() + ": the last " + std::to_string(spare) +
                                     " corners make no whole triangle and are left out");
  }
  auto kept = compact(mesh.triangles, vertices.size());
  mesh.positions = world_positions(source, vertices, kept, scene.origin);
  counts.coarse += is_far_for_its_size(bounds_of(vertices, kept)) ? 1 : 0;
  const Dropped dropped = drop_unusable(mesh.triangles, mesh.positions);
  if (dropped.total() > 0) {
    counts.dropped.non_finite += dropped.non_finite;
    counts.dropped.degenerate += dropped.degenerate;
    std::vector<std::uint32_t> remaining = compact(mesh.triangles, kept.size());
    for (std::size_t i = 0; i < remaining.size(); ++i) {
      mesh.positions[i] = mesh.positions[remaining[i]];
      remaining[i] = kept[remaining[i]];
    }
    mesh.positions.resize(remaining.size());
    kept = std::move(remaining);
  }
  if (source.attribute("NORMAL") >= 0 && (source.node.rank == 3 || source.skinned())) {
    mesh.normals = world_normals(vertices, kept);
    counts.normals += mend_normals(mesh);
  }
  read_uvs(source, kept, scene.materials[mesh.material], mesh, warnings);
  warn_of_vertices(source, vertices, warnings);
  return mesh;
}

/// The number of additions for morph targets and joints: four joints for each JOINTS_n.
std::size_t moves_of(const file::Model& model, const file::Primitive& primitive,
                     const PlacedNode& node) {
  const std::size_t vertices =
      model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))].count;
  const std::size_t targets = std::min(primitive.targets.size(), node.weights.size());
  const auto unused = std::count(node.weights.begin(),
                                 node.weights.begin() + static_cast<std::ptrdiff_t>(targets), 0.0);
  const auto joint_sets = std::ranges::count_if(
      primitive.attributes, [](const auto& a) { return a.first.starts_with("JOINTS_"); });
  const std::size_t joints = node.skin ? 4 * static_cast<std::size_t>(joint_sets) : 0;
  return vertices * (targets - static_cast<std::size_t>(unused) + joints);
}

/// Counts before anything is built: a file of a few kilobytes can place one mesh a million times,
/// and a morph target of a few bytes, which shares an accessor, can move every vertex.
void check_total(const file::Model& model, const std::vector<PlacedNode>& nodes) {
  std::size_t total = 0;
  std::size_t moves = 0;
  for (const PlacedNode& node : nodes) {
    const auto mesh = mesh_of(model, node);
    if (!mesh) continue;
    for (const auto& primitive : model.meshes[*mesh].primitives) {
      if (!is_drawn(primitive)) continue;
      total += count_triangles(model, primitive);
      moves += moves_of(model, primitive, node);
      if (moves > max_moves) {
        node.place.fail("morph targets and joints move vertices more than " +
                        std::to_string(max_moves) + " times in all down to here");
      }
      if (total > max_triangles) {
        node.place.fail("more than " + std::to_string(max_triangles) +
                        " triangles in all down to here");
      }
    }
  }
}

void add_node(const file::Model& model, const PlacedNode& node, const Skins& skins,
              SceneData& scene, Counts& counts, Warnings& warnings) {
  const auto mesh_index = mesh_of(model, node);
  if (!mesh_index) return;
  const file::Mesh& mesh = model.meshes[*mesh_index];
  for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
    const file::Primitive& primitive = mesh.primitives[k];
    if (!is_drawn(primitive)) {
      ++(is_triangle_mode(primitive.mode) ? counts.without_position : counts.points_and_lines);
      continue;
    }
    const Source source{model, *mesh_index, k, node, skins};
    if (source.hidden()) continue;
    Mesh built = build_mesh(source, scene, counts, warnings);
    built.name = mesh.name.empty() ? node.place.string("name", node.place.label()) : mesh.name;
    if (!built.triangles.empty()) scene.meshes.push_back(std::move(built));
  }
}

/// "3 primitives of points or lines, 2 meshes under a scale of 0"; empty: nothing was left out.
std::string left_out(const Counts& counts) {
  std::string text;
  for (const auto& [count, what] :
       {std::pair(counts.points_and_lines, " primitives of points or lines"),
        {counts.without_position, " primitives without POSITION"},
        {counts.hidden, " meshes under a scale of 0"}}) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
  }
  return text;
}

}  // namespace

void build_meshes(const file::Model& model, const std::vector<PlacedNode>& nodes,
                  const Skins& skins, SceneData& scene, Warnings& warnings) {
  check_total(model, nodes);
  scene.origin = scene_origin(model, nodes, skins);
  Counts counts;
  for (const PlacedNode& node : nodes) {
    if (node.place.has("mesh") && node.rank < 2 && !node.skin) ++counts.hidden;
    add_node(model, node, skins, scene, counts, warnings);
  }
  scene.dropped_triangles = counts.dropped.total();
  const std::string dropped = std::to_string(counts.dropped.degenerate) + " of zero area, " +
                              std::to_string(counts.dropped.non_finite) +
                              " with a vertex that is not finite";
  const std::string others = left_out(counts);
  if (scene.meshes.empty()) {
    throw SceneError("the scene has no triangles (dropped: " + dropped +
                     (others.empty() ? "" : "; left out: " + others) + ")");
  }
  if (!others.empty()) warnings.once("left out: " + others);
  if (scene.dropped_triangles > 0) warnings.once("triangles dropped: " + dropped);
  if (counts.normals > 0) {
    warnings.once(std::to_string(counts.normals) +
                  " normals were zero or not finite and were replaced by geometric ones");
  }
  merge_equal_emitters(scene, warnings);
  warn_of_places(scene, counts.coarse, warnings);
  Hasher hasher;
  for (const Mesh& mesh : scene.meshes) {
    hasher.add(std::span(mesh.positions));
    hasher.add(std::span(mesh.triangles));
  }
  scene.geometry_hash = hasher.digest();
}

}  // namespace lacuna::gltf
