#include "renderer/gltf/gltf_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "renderer/core/huge_pages.h"
#include "renderer/gltf/gltf_attributes.h"
#include "renderer/gltf/gltf_duplicates.h"
#include "renderer/gltf/gltf_instances.h"
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
  std::uint64_t hidden = 0;     ///< nodes with a mesh and a scale that leaves nothing of it
  std::uint64_t invisible = 0;  ///< primitives; see Material::invisible()
};

/// Positions relative to `origin`. A vertex that is not finite in the file stays so: its triangles
/// are dropped.
std::vector<V3f> world_positions(const Source& source, const Vertices& vertices,
                                 const std::vector<std::uint32_t>& kept, const V3d& origin) {
  std::vector<V3f> out;
  reserve_huge(out, kept.size() + 1);  // as RayCaster wants it
  out.resize(kept.size());
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
  std::vector<V3f> out;
  reserve_huge(out, kept.size());
  for (const std::uint32_t v : kept) out.push_back(vertices.world_normal(v));
  return out;
}

/// Gives every vertex without a usable normal the geometric one of the first triangle that uses it.
std::uint64_t mend_normals(Mesh& mesh) {
  std::uint64_t mended = 0;
  if (std::ranges::find(mesh.normals, V3f(0, 0, 0)) == mesh.normals.end()) return mended;
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

bool is_read(const std::string& attribute) {
  constexpr auto read = std::to_array<std::string_view>(
      {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"});
  return std::ranges::find(read, attribute) != read.end();
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

/// Positions are relative to `origin`.
Mesh build_mesh(const Source& source, const SceneData& scene, const V3d& origin, Counts& counts,
                Warnings& warnings) {
  Mesh mesh;
  mesh.material = static_cast<std::uint32_t>(material_of(source.primitive(), scene.materials));
  const Vertices vertices(source);
  mesh.triangles = assemble_triangles(source.model, source.primitive(), vertices.size(),
                                      vertices.mirrored(), source.place());
  if (const auto spare = spare_corners(source.model, source.primitive()); spare > 0) {
    warnings.first_of("corners", source.place() + ": the last " + std::to_string(spare) +
                                     " corners make no whole triangle and are left out");
  }
  auto kept = compact(mesh.triangles, vertices.size());
  mesh.positions = world_positions(source, vertices, kept, origin);
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
  read_attributes(source, vertices, kept, scene.materials[mesh.material], mesh, warnings);
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
void check_total(const file::Model& model, const std::vector<PlacedNode>& nodes,
                 const SharedMeshes& shared, const std::vector<Material>& materials) {
  std::size_t total = 0;
  std::size_t moves = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PlacedNode& node = nodes[i];
    const auto mesh = mesh_of(model, node);
    if (!mesh) continue;
    const bool instance = shared.placed_as_instance(i);
    for (const auto& primitive : model.meshes[*mesh].primitives) {
      if (!is_drawn(primitive)) continue;
      if (instance && !materials[material_of(primitive, materials)].emits()) continue;
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

/// "3 primitives of points or lines, 2 meshes under a scale of 0"; empty: nothing was left out.
std::string left_out(const Counts& counts) {
  std::string text;
  for (const auto& [count, what] :
       {std::pair(counts.points_and_lines, " primitives of points or lines"),
        {counts.without_position, " primitives without POSITION"},
        {counts.hidden, " meshes under a scale of 0"},
        {counts.invisible, " primitives of alphaMode BLEND with alpha 0"}}) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
  }
  return text;
}

/// Which primitives of a mesh.
enum class Part { all, emitting, not_emitting };

/// Builds the meshes of a scene.
class Builder {
 public:
  Builder(const file::Model& model, const Skins& skins, SceneData& scene, Warnings& warnings)
      : model_(model), skins_(skins), scene_(scene), warnings_(warnings) {}

  /// Adds meshes of a node, relative to `origin`.
  void add_node(const PlacedNode& node, Part part, const V3d& origin);
  /// Adds the instances of those nodes that place shared meshes, and the prototypes.
  void add_instances(const std::vector<PlacedNode>& nodes, const SharedMeshes& shared);
  void warn() const;
  Counts counts;

 private:
  /// The copy of a material for meshes with vertex colours.
  std::uint32_t with_vertex_colors(std::uint32_t material);
  bool is_in(Part part, const file::Primitive& primitive) const {
    const bool emits = scene_.materials[material_of(primitive, scene_.materials)].emits();
    return part == Part::all || (part == Part::emitting) == emits;
  }
  /// Adds a prototype of the mesh of a node; returns its middle, in the mesh's coordinates.
  V3d add_prototype(const PlacedNode& node);

  const file::Model& model_;
  const Skins& skins_;
  SceneData& scene_;
  Warnings& warnings_;
  std::map<std::uint32_t, std::uint32_t> colored_;  // copies of materials, by the original
};

std::uint32_t Builder::with_vertex_colors(std::uint32_t material) {
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [found, is_new] = colored_.try_emplace(material, next);
  if (is_new) {
    scene_.materials.push_back(Material(scene_.materials[material]));
    scene_.materials.back().vertex_colors = true;
  }
  return found->second;
}

void Builder::add_node(const PlacedNode& node, Part part, const V3d& origin) {
  if (node.place.has("mesh") && node.rank < 2 && !node.skin) ++counts.hidden;
  const auto mesh_index = mesh_of(model_, node);
  if (!mesh_index) return;
  const file::Mesh& mesh = model_.meshes[*mesh_index];
  for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
    const file::Primitive& primitive = mesh.primitives[k];
    if (!is_in(part, primitive)) continue;
    if (!is_drawn(primitive)) {
      ++(is_triangle_mode(primitive.mode) ? counts.without_position : counts.points_and_lines);
      continue;
    }
    const Source source{model_, *mesh_index, k, node, skins_};
    if (source.hidden()) continue;
    if (scene_.materials[material_of(primitive, scene_.materials)].invisible()) {
      ++counts.invisible;
      continue;
    }
    Mesh built = build_mesh(source, scene_, origin, counts, warnings_);
    if (!built.colors.empty()) built.material = with_vertex_colors(built.material);
    built.name = mesh.name.empty() ? node.place.string("name", node.place.label()) : mesh.name;
    if (!built.triangles.empty()) scene_.meshes.push_back(std::move(built));
  }
}

V3d Builder::add_prototype(const PlacedNode& node) {
  PlacedNode unplaced = node;
  unplaced.to_world = M44d();
  const std::size_t first = scene_.meshes.size();
  add_node(unplaced, Part::not_emitting, V3d(0.0));
  const std::span<Mesh> added = std::span(scene_.meshes).subspan(first);
  scene_.prototypes.push_back(
      {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(added.size())});
  const Bounds box = bounds_of(added);
  const V3d middle = box.empty() ? V3d(0.0) : (box.low + box.high) / 2;
  for (Mesh& mesh : added) {
    for (V3f& p : mesh.positions) p = V3f(V3d(p) - middle);
  }
  return middle;
}

void Builder::add_instances(const std::vector<PlacedNode>& nodes, const SharedMeshes& shared) {
  struct Added {
    std::uint32_t prototype;
    V3d middle;
    Bounds box;
  };
  std::map<std::pair<std::size_t, bool>, Added> added;  // by mesh and whether it is mirrored
  scene_.instances.reserve(shared.instances());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!shared.placed_as_instance(i)) continue;
    const PlacedNode& node = nodes[i];
    const auto key = std::pair(*mesh_of(model_, node), node.mirrored);
    auto it = added.find(key);
    if (it == added.end()) {
      const V3d middle = add_prototype(node);
      const auto index = static_cast<std::uint32_t>(scene_.prototypes.size() - 1);
      const Bounds box = bounds_of(scene_.meshes_of(scene_.prototypes.back()));
      it = added.emplace(key, Added{index, middle, box}).first;
    }
    const auto& [prototype, middle, box] = it->second;
    if (box.empty()) continue;  // all of its triangles were dropped
    M44d to_scene = node.to_world;
    const V3d at = middle * node.to_world - scene_.origin;
    for (int k = 0; k < 3; ++k) to_scene[3][k] = at[k];
    const Instance& instance = scene_.instances.emplace_back(to_scene, prototype);
    const Bounds placed = instance.bounds(box);
    for (int k = 0; k < 3; ++k) {
      if (std::max(std::abs(placed.low[k]), std::abs(placed.high[k])) <= max_coordinate) continue;
      node.place.fail("its mesh reaches from " + std::to_string(placed.low[k]) + " to " +
                      std::to_string(placed.high[k]) + "; allowed: " + coordinate_rule);
    }
  }
  scene_.bound_ray_errors();
}

void Builder::warn() const {
  const std::string dropped = std::to_string(counts.dropped.degenerate) + " of zero area, " +
                              std::to_string(counts.dropped.non_finite) +
                              " with a vertex that is not finite";
  const std::string others = left_out(counts);
  if (scene_.meshes.empty()) {
    throw SceneError("the scene has no triangles (dropped: " + dropped +
                     (others.empty() ? "" : "; left out: " + others) + ")");
  }
  if (!others.empty()) warnings_.once("left out: " + others);
  if (counts.dropped.total() > 0) warnings_.once("triangles dropped: " + dropped);
  if (counts.normals > 0) {
    warnings_.once(std::to_string(counts.normals) +
                   " normals were zero or not finite and were replaced by geometric ones");
  }
}

std::uint64_t geometry_hash(const SceneData& scene) {
  Hasher hasher;
  for (const Mesh& mesh : scene.meshes) {
    hasher.add(std::span(mesh.positions));
    hasher.add(std::span(mesh.triangles));
  }
  if (!scene.instances.empty()) {
    hasher.add(std::span(scene.prototypes));
    hasher.add(std::span(scene.instances));
  }
  return hasher.digest();
}

}  // namespace

void build_meshes(const file::Model& model, const std::vector<PlacedNode>& nodes,
                  const Skins& skins, SceneData& scene, Warnings& warnings) {
  const SharedMeshes shared(model, nodes, scene.materials);
  check_total(model, nodes, shared, scene.materials);
  scene.origin = scene_origin(model, nodes, skins);
  Builder builder(model, skins, scene, warnings);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Part part = shared.placed_as_instance(i) ? Part::emitting : Part::all;
    builder.add_node(nodes[i], part, scene.origin);
  }
  merge_equal_emitters(scene, warnings);
  builder.add_instances(nodes, shared);
  builder.warn();
  scene.dropped_triangles = builder.counts.dropped.total();
  warn_of_places(scene, builder.counts.coarse, warnings);
  scene.geometry_hash = geometry_hash(scene);
}

}  // namespace lacuna::gltf
