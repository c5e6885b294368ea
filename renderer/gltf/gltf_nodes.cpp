#include "renderer/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

constexpr int max_levels = 256;
constexpr std::size_t none = static_cast<std::size_t>(-1);

/// The transform of a node, and the same with scales of 0 taken as 1.
struct LocalTransform {
  M44d exact, turn;
};

const NodePose& pose_of(const Pose& pose, std::size_t node) {
  static const NodePose unposed;
  const auto found = pose.find(node);
  return found == pose.end() ? unposed : found->second;
}

LocalTransform local_transform(const GltfObject& node, const NodePose& pose) {
  if (const auto a = node.numbers<16>("matrix", Limits{})) {
    const M44d m = matrix_of(*a);
    return {m, m};
  }
  const auto property = [&]<std::size_t N>(const std::optional<std::array<double, N>>& posed,
                                           const char* key, const std::array<double, N>& fallback) {
    return posed ? *posed : node.numbers<N>(key, Limits{}).value_or(fallback);
  };
  const auto scale = property(pose.scale, "scale", {1, 1, 1});
  const auto shift = property(pose.translation, "translation", {0, 0, 0});
  const auto rotation = property(pose.rotation, "rotation", {0, 0, 0, 1});
  auto visible = scale;
  for (double& s : visible) s = s == 0 ? 1 : s;
  return {transform_of(scale, rotation, shift), transform_of(visible, rotation, shift)};
}

bool carries_something(const GltfObject& node) {
  const auto light = node.extension("KHR_lights_punctual");
  return node.has("mesh") || node.has("camera") || (light && light->has("light"));
}

struct Forest {
  std::vector<std::size_t> parents;  ///< `none` for a root
  std::vector<std::size_t> order;    ///< all nodes, each after its parent
};

/// Every node has at most one parent and no node is its own ancestor.
Forest check_forest(const std::vector<GltfObject>& nodes) {
  std::vector<std::size_t> parents(nodes.size(), none);
  std::vector<std::vector<std::size_t>> children(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    children[i] = nodes[i].indices("children", nodes.size(), "nodes");
    for (const std::size_t child : children[i]) {
      if (parents[child] != none) {
        nodes[child].fail("has two parents, " + nodes[parents[child]].label() + " and " +
                          nodes[i].label());
      }
      parents[child] = i;
    }
  }
  // With one parent each, nodes that cannot be reached from a root lie on or below a cycle.
  std::vector<std::size_t> reached;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] == none) reached.push_back(i);
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto& next = children[reached[i]];
    reached.insert(reached.end(), next.begin(), next.end());
  }
  if (reached.size() < nodes.size()) {
    std::vector<bool> seen(nodes.size());
    for (const std::size_t i : reached) seen[i] = true;
    const auto lost = std::find(seen.begin(), seen.end(), false) - seen.begin();
    nodes[static_cast<std::size_t>(lost)].fail("is its own ancestor, or lies below a node that is");
  }
  return {std::move(parents), std::move(reached)};
}

/// The weights of the morph targets of a node's mesh: those of the pose, of the node or of the
/// mesh.
std::vector<double> morph_weights(const GltfObject& node, const std::vector<GltfObject>& meshes,
                                  const NodePose& pose) {
  const auto mesh = node.index("mesh", meshes.size(), "meshes");
  if (!mesh) return {};
  if (pose.weights) return *pose.weights;
  return (node.has("weights") ? node : meshes[*mesh]).number_list("weights", any_float);
}

std::vector<std::size_t> scene_roots(const GltfObject& root, const std::vector<GltfObject>& nodes,
                                     const std::vector<std::size_t>& parents) {
  std::vector<std::size_t> roots;
  const auto scenes = root.objects("scenes");
  if (scenes.empty()) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (parents[i] == none) roots.push_back(i);
    }
    return roots;
  }
  const GltfObject& scene = scenes[root.index("scene", scenes.size(), "scenes").value_or(0)];
  roots = scene.indices("nodes", nodes.size(), "nodes");
  std::vector<bool> listed(nodes.size());
  for (const std::size_t i : roots) {
    if (listed[i]) scene.fail("lists " + nodes[i].label() + " twice");
    if (parents[i] != none) {
      scene.fail("lists " + nodes[i].label() + ", which is a child of " +
                 nodes[parents[i]].label());
    }
    listed[i] = true;
  }
  return roots;
}

struct Visit {
  std::size_t node;
  int level;
  M44d to_world, turn;
  int rank = 3;
  bool visible = true;
  std::size_t flat_at = none;  ///< the last ancestor that lowered the rank
};

/// Warns of the meshes, cameras and lights at a node whose transform has a lower rank.
void warn_of_rank(const GltfObject& node, int rank, const GltfObject& flattening,
                  Warnings& warnings) {
  const std::string place = flattening.label();
  if (node.has("mesh") && rank == 2) {
    warnings.first_of("flattened", place +
                                       ": its scale is 0 along one axis; the meshes at and below "
                                       "it are flattened into a plane and get its normal");
  } else if (node.has("mesh")) {
    warnings.first_of("hidden",
                      place + ": its scale is 0; the meshes at and below it are left out");
  }
  if (node.has("camera") || node.extension("KHR_lights_punctual")) {
    warnings.first_of("unscaled", place +
                                      ": its scale is 0, which does not hide the cameras and "
                                      "lights at and below it: they have no size");
  }
}

}  // namespace

std::vector<M44d> node_transforms(const GltfObject& root, const Pose& pose) {
  const auto nodes = root.objects("nodes");
  const Forest forest = check_forest(nodes);
  std::vector<M44d> out(nodes.size());
  for (const std::size_t i : forest.order) {
    out[i] = local_transform(nodes[i], pose_of(pose, i)).exact;
    if (forest.parents[i] != none) out[i] *= out[forest.parents[i]];
  }
  return out;
}

std::vector<PlacedNode> place_nodes(const GltfObject& root, const Pose& pose, Warnings& warnings) {
  const auto nodes = root.objects("nodes");
  const auto meshes = root.objects("meshes");
  const auto skins = root.array_size("skins");
  const auto parents = check_forest(nodes).parents;
  const auto roots = scene_roots(root, nodes, parents);

  std::vector<PlacedNode> placed;
  std::vector<Visit> stack;
  for (auto it = roots.rbegin(); it != roots.rend(); ++it)
    stack.push_back({*it, 1, M44d(), M44d()});
  while (!stack.empty()) {
    Visit visit = stack.back();
    stack.pop_back();
    const GltfObject& node = nodes[visit.node];
    if (visit.level > max_levels) {
      node.fail("lies more than " + std::to_string(max_levels) + " levels deep");
    }
    const LocalTransform local = local_transform(node, pose_of(pose, visit.node));
    visit.to_world = local.exact * visit.to_world;
    visit.turn = local.turn * visit.turn;
    if (const int own = rank_of(visit.to_world); own < visit.rank) {
      visit.rank = own;
      visit.flat_at = visit.node;
    }
    if (const auto own = node.extension("KHR_node_visibility")) {
      visit.visible = own->boolean("visible", true) && visit.visible;
    }
    if (carries_something(node)) {
      if (!all_finite(visit.to_world) || !all_finite(visit.turn)) {
        node.fail("its transform, with those of its parents, is too large or not finite");
      }
      std::optional<std::size_t> skin;
      if (node.has("mesh")) skin = node.index("skin", skins, "skins");
      if (visit.rank < 3 && !skin) warn_of_rank(node, visit.rank, nodes[visit.flat_at], warnings);
      const bool can_turn = rank_of(visit.turn) == 3;
      placed.push_back({node, visit.to_world, visit.rank, visit.turn, can_turn,
                        can_turn && determinant3(visit.turn) < 0,
                        morph_weights(node, meshes, pose_of(pose, visit.node)), skin,
                        visit.visible});
    }
    const auto children = node.indices("children", nodes.size(), "nodes");
    for (auto it = children.rbegin(); it != children.rend(); ++it) {
      Visit below = visit;
      below.node = *it;
      ++below.level;
      stack.push_back(below);
    }
  }
  return placed;
}

}  // namespace lacuna::gltf
