#include "renderer/gltf/gltf_vertices.h"

#include <cmath>

namespace lacuna::gltf {
namespace {

V3d vector_of(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

MorphTargets::MorphTargets(const Source& source, const std::string& attribute) {
  const auto& targets = source.primitive().targets;
  const auto& weights = source.node.weights;
  for (std::size_t k = 0; k < std::min(targets.size(), weights.size()); ++k) {
    const auto found = targets[k].find(attribute);
    if (weights[k] == 0 || found == targets[k].end()) continue;
    targets_.push_back(
        {weights[k],
         source.view_of(found->second, "targets[" + std::to_string(k) + "]." + attribute,
                        ElementType::vec3, Components::quantized)});
  }
}

V3d MorphTargets::add_to(V3d base, std::size_t i) const {
  for (const Target& t : targets_) base += vector_of(t.displacements.floats<3>(i)) * t.weight;
  return base;
}

SkinWeights::SkinWeights(const Source& source)
    : joints_(source.skins[*source.node.skin]),
      vertices_(
          source.model.accessors[static_cast<std::size_t>(source.attribute("POSITION"))].count) {
  for (int set = 0; source.attribute("JOINTS_" + std::to_string(set)) >= 0; ++set) {
    const std::string number = std::to_string(set);
    if (source.attribute("WEIGHTS_" + number) < 0) break;
    sets_.push_back({source.view("JOINTS_" + number, ElementType::vec4, Components::joints),
                     source.view("WEIGHTS_" + number, ElementType::vec4, Components::normalized)});
  }
  for (std::size_t i = 0; i < vertices_; ++i) {
    double sum = 0;
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      const auto weights = sets_[s].weights.floats<4>(i);
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t joint = sets_[s].joints.integer(i, k);
        sum += weights[k];
        if (weights[k] == 0 || joint < joints_.size()) continue;
        throw SceneError(source.place() + ": JOINTS_" + std::to_string(s) + " of vertex " +
                         std::to_string(i) + " has " + std::to_string(joint) + "; allowed: below " +
                         std::to_string(joints_.size()) + ", the joints of its skin");
      }
    }
    if (sum == 0) ++without_weights_;
    if (determinant3(to_world(i)) < 0) ++mirrored_;
  }
}

M44d SkinWeights::to_world(std::size_t i) const {
  M44d blend(0.0);
  double sum = 0;
  for (const Set& set : sets_) {
    const auto weights = set.weights.floats<4>(i);
    for (std::size_t k = 0; k < 4; ++k) {
      if (weights[k] == 0) continue;
      blend += joints_[set.joints.integer(i, k)] * static_cast<double>(weights[k]);
      sum += weights[k];
    }
  }
  if (sum == 0) return joints_.front();
  return blend / sum;
}

Vertices::NormalTransform::NormalTransform(const M44d& m, bool mirrored) {
  const double sign = mirrored ? -1 : 1;
  for (int i = 0; i < 3; ++i) axes[i] = row(m, (i + 1) % 3).cross(row(m, (i + 2) % 3)) * sign;
}

Vertices::Vertices(const Source& source)
    : source_(source),
      positions_(source.view("POSITION", ElementType::vec3, Components::quantized)),
      position_targets_(source, "POSITION"),
      normal_targets_(source, "NORMAL"),
      rigid_normals_(source.node.to_world, source.node.mirrored) {
  if (source.attribute("NORMAL") >= 0) {
    normals_.emplace(source.view("NORMAL", ElementType::vec3, Components::normalized));
  }
  if (source.skinned()) skin_.emplace(source);
}

V3d Vertices::local(std::size_t i) const {
  return position_targets_.add_to(vector_of(positions_.floats<3>(i)), i);
}

bool Vertices::finite(std::size_t i) const {
  if (!is_finite(V3f(local(i)))) return false;
  return !skin_ || is_finite(V3f(row(skin_->to_world(i), 3)));
}

V3d Vertices::world(std::size_t i) const {
  return local(i) * (skin_ ? skin_->to_world(i) : source_.node.to_world);
}

V3f Vertices::world_normal(std::size_t i) const {
  const V3d n = normal_targets_.add_to(vector_of(normals_->floats<3>(i)), i);
  const auto turned = [&n](const NormalTransform& t) {
    return t.axes[0] * n[0] + t.axes[1] * n[1] + t.axes[2] * n[2];
  };
  V3d world;
  if (skin_) {
    const M44d m = skin_->to_world(i);
    world = turned(NormalTransform(m, determinant3(m) < 0));
  } else {
    world = turned(rigid_normals_);
  }
  const double length = world.length();
  return std::isnormal(length) ? V3f(world / length) : V3f(0, 0, 0);
}

V4f Vertices::world_tangent(std::size_t i, const V3d& tangent, float sign) const {
  const M44d m = skin_ ? skin_->to_world(i) : source_.node.to_world;
  const V3d world = row(m, 0) * tangent.x + row(m, 1) * tangent.y + row(m, 2) * tangent.z;
  const double length = world.length();
  if (!std::isnormal(length)) return {0, 0, 0, 1};
  const V3f unit(world / length);
  // The transform of a cross product points the other way where it mirrors. (A prototype of a
  // mirrored node is not placed yet, but has its normals turned.)
  const bool is_mirrored = skin_ ? determinant3(m) < 0 : source_.node.mirrored;
  return {unit.x, unit.y, unit.z, is_mirrored ? -sign : sign};
}

bool Vertices::mirrored() const { return skin_ ? skin_->mirrored() : source_.node.mirrored; }

}  // namespace lacuna::gltf
