#include "renderer/gltf/gltf_instances.h"

#include <algorithm>
#include <cmath>

#include "renderer/gltf/gltf_primitives.h"

namespace lacuna::gltf {
namespace {

constexpr std::size_t max_instances = std::size_t{1} << 24;
constexpr std::size_t max_copied_triangles = std::size_t{1} << 20;

/// The attributes of a node's EXT_mesh_gpu_instancing.
class InstanceAttributes {
 public:
  InstanceAttributes(const file::Model& model, const GltfObject& node, const GltfObject& extension,
                     Warnings& warnings) {
    const auto attributes = extension.object("attributes");
    if (!attributes) extension.fail("attributes is missing");
    const std::string use = " of EXT_mesh_gpu_instancing of " + node.label();
    for (const std::string& name : attributes->keys()) {
      const auto accessor =
          static_cast<int>(attributes->index(name, model.accessors.size(), "accessors").value());
      const auto view = [&](ElementType type, Components components) {
        AccessorView v(model, accessor, type, components, name + use);
        if (count_ && *count_ != v.size()) {
          attributes->fail(name + " has " + std::to_string(v.size()) + " elements; allowed: " +
                           std::to_string(*count_) + ", as the others have");
        }
        count_ = v.size();
        return v;
      };
      if (name == "TRANSLATION") {
        translation_ = view(ElementType::vec3, Components::floats);
      } else if (name == "ROTATION") {
        rotation_ = view(ElementType::vec4, Components::normalized);
      } else if (name == "SCALE") {
        scale_ = view(ElementType::vec3, Components::floats);
      } else {
        warnings.once("attribute " + name + " of EXT_mesh_gpu_instancing is left out");
      }
    }
    if (!count_) attributes->fail("it has none of TRANSLATION, ROTATION and SCALE");
  }

  std::size_t size() const { return *count_; }
  /// The transform of instance `i` in the coordinates of its node.
  M44d transform(std::size_t i) const {
    const auto read = [i]<std::size_t N>(const std::optional<AccessorView>& view,
                                         std::array<double, N> value) {
      if (!view) return value;
      const auto floats = view->floats<N>(i);
      std::copy(floats.begin(), floats.end(), value.begin());
      return value;
    };
    return transform_of(read(scale_, std::array<double, 3>{1, 1, 1}),
                        read(rotation_, std::array<double, 4>{0, 0, 0, 1}),
                        read(translation_, std::array<double, 3>{0, 0, 0}));
  }

 private:
  std::optional<std::size_t> count_;
  std::optional<AccessorView> translation_, rotation_, scale_;
};

/// Whether Embree's transform of rays, in single precision, stays accurate: the determinant, a cube
/// of the scale, is in the range of floats, and a condition of 64 moves the start of rays by less
/// than 2^-14 of the scene's size (Instance::set_reach()).
bool inverts_well(const M44d& to_world) {
  const Instance instance(to_world, 0);
  constexpr float largest = 0x1p30F, most = 64;
  return instance.stretch < largest && instance.stretch > 1 / largest && instance.condition < most;
}

bool can_share(const PlacedNode& node) {
  return node.rank == 3 && !node.skin &&
         std::ranges::all_of(node.weights, [](double w) { return w == 0; }) &&
         inverts_well(node.to_world);
}

/// Those of a mesh that do not emit: emitters are sampled one by one, so that each has a copy.
std::size_t shared_triangles(const file::Model& model, const file::Mesh& mesh,
                             const std::vector<Material>& materials) {
  std::size_t count = 0;
  for (const file::Primitive& p : mesh.primitives) {
    if (is_drawn(p) && !materials[material_of(p, materials)].emits()) {
      count += count_triangles(model, p);
    }
  }
  return count;
}

}  // namespace

std::optional<std::vector<PlacedNode>> expand_instances(const file::Model& model,
                                                        const std::vector<PlacedNode>& nodes,
                                                        Warnings& warnings) {
  const auto extension_of = [](const PlacedNode& node) {
    return node.place.extension("EXT_mesh_gpu_instancing");
  };
  if (std::ranges::none_of(nodes, [&](const auto& n) { return extension_of(n).has_value(); })) {
    return std::nullopt;
  }
  std::vector<PlacedNode> out;
  out.reserve(nodes.size());
  for (const PlacedNode& node : nodes) {
    const auto extension = extension_of(node);
    if (!extension) {
      out.push_back(node);
      continue;
    }
    const InstanceAttributes attributes(model, node.place, *extension, warnings);
    if (out.size() + attributes.size() > max_instances) {
      node.place.fail("more than " + std::to_string(max_instances) +
                      " instances in all down to here");
    }
    const std::size_t needed = out.size() + attributes.size();
    if (needed > out.capacity()) out.reserve(std::max(needed, 2 * out.capacity()));
    for (std::size_t i = 0; i < attributes.size(); ++i) {
      PlacedNode& instance = out.emplace_back(node);
      instance.to_world = attributes.transform(i) * node.to_world;
      if (!all_finite(instance.to_world)) {
        node.place.fail("the transform of instance " + std::to_string(i) +
                        " is too large or not finite");
      }
      instance.rank = rank_of(instance.to_world);
      instance.mirrored = determinant3(instance.to_world) < 0;
    }
  }
  return out;
}

SharedMeshes::SharedMeshes(const file::Model& model, const std::vector<PlacedNode>& nodes,
                           const std::vector<Material>& materials) {
  std::vector<std::size_t> uses(model.meshes.size());
  is_instance_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto mesh = mesh_of(model, nodes[i]);
    is_instance_[i] = mesh && can_share(nodes[i]);
    if (is_instance_[i]) ++uses[*mesh];
  }
  std::size_t copies = 0;
  std::vector<bool> shared(model.meshes.size());
  for (std::size_t m = 0; m < uses.size(); ++m) {
    if (uses[m] < 2) continue;
    const std::size_t triangles = shared_triangles(model, model.meshes[m], materials);
    shared[m] = triangles > 0;
    copies += (uses[m] - 1) * triangles;  // of 2^24 nodes and 2^27 triangles at most, and as many
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_instance_[i]) continue;
    is_instance_[i] = copies > max_copied_triangles && shared[*mesh_of(model, nodes[i])];
    if (is_instance_[i]) ++instances_;
  }
}

}  // namespace lacuna::gltf
