#include "renderer/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

constexpr int max_levels = 256;
constexpr std::size_t none = static_cast<std::size_t>(-1);

double determinant3(const M44d& m) { return row(m, 0).dot(row(m, 1).cross(row(m, 2))); }

/// glTF stores columns for column vectors, which is what Imath stores as rows for row vectors.
M44d local_transform(const GltfObject& node) {
  M44d m;
  if (const auto a = node.numbers<16>("matrix", Limits{})) {
    for (std::size_t i = 0; i < 16; ++i) m[static_cast<int>(i / 4)][i % 4] = (*a)[i];
    return m;
  }
  const auto scale = node.numbers<3>("scale", Limits{}).value_or(std::array{1.0, 1.0, 1.0});
  const auto shift = node.numbers<3>("translation", Limits{}).value_or(std::array{0.0, 0.0, 0.0});
  auto q = node.numbers<4>("rotation", Limits{}).value_or(std::array{0.0, 0.0, 0.0, 1.0});
  const double norm = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
  for (double& component : q) component /= norm;
  const auto [x, y, z, w] = q;
  const V3d axes[3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
      {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
      {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[i][j] = scale[static_cast<std::size_t>(i)] * axes[i][j];
    m[3][i] = shift[static_cast<std::size_t>(i)];
  }
  return m;
}

bool usable(const M44d& m) {
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (!std::isfinite(m[i][j])) return false;
    }
  }
  // Relative to the lengths of the axes, so that a scale of 1e-8 along one of them is fine; what is
  // left below 1e-12 is cancellation in the products of matrices.
  const double lengths = row(m, 0).length() * row(m, 1).length() * row(m, 2).length();
  const double det = std::abs(determinant3(m));
  return std::isnormal(lengths) && std::isnormal(det) && det > 1e-12 * lengths;
}

bool carries_something(const GltfObject& node) {
  const auto light = node.extension("KHR_lights_punctual");
  return node.has("mesh") || node.has("camera") || (light && light->has("light"));
}

/// Every node has at most one parent and no node is its own ancestor. Returns the parents.
std::vector<std::size_t> check_forest(const std::vector<GltfObject>& nodes) {
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
  // With one parent each, whatever cannot be reached from a root lies on or below a cycle.
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
  return parents;
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
  M44d to_world;
  std::size_t singular_at;  ///< the first ancestor where the transform became unusable
};

}  // namespace

std::vector<PlacedNode> place_nodes(const GltfObject& root) {
  const auto nodes = root.objects("nodes");
  const auto parents = check_forest(nodes);
  const auto roots = scene_roots(root, nodes, parents);

  std::vector<PlacedNode> placed;
  std::vector<Visit> stack;
  for (auto it = roots.rbegin(); it != roots.rend(); ++it) stack.push_back({*it, 1, M44d(), none});
  while (!stack.empty()) {
    Visit visit = stack.back();
    stack.pop_back();
    const GltfObject& node = nodes[visit.node];
    if (visit.level > max_levels) {
      node.fail("lies more than " + std::to_string(max_levels) + " levels deep");
    }
    visit.to_world = local_transform(node) * visit.to_world;
    if (visit.singular_at == none && !usable(visit.to_world)) visit.singular_at = visit.node;
    if (carries_something(node)) {
      if (visit.singular_at != none) {
        nodes[visit.singular_at].fail("its transform is singular or not finite; " + node.label() +
                                      " needs one that can be inverted");
      }
      placed.push_back({node, visit.to_world, determinant3(visit.to_world)});
    }
    const auto children = node.indices("children", nodes.size(), "nodes");
    for (auto it = children.rbegin(); it != children.rend(); ++it) {
      stack.push_back({*it, visit.level + 1, visit.to_world, visit.singular_at});
    }
  }
  return placed;
}

}  // namespace lacuna::gltf
