#pragma once

#include <optional>
#include <vector>

#include "renderer/gltf/gltf_primitives.h"

namespace lacuna::gltf {

/// The morph targets of one attribute that have a weight.
class MorphTargets {
 public:
  MorphTargets(const Source& source, const std::string& attribute);

  bool empty() const { return targets_.empty(); }
  /// `base` with the weighted displacements of vertex `i`.
  V3d add_to(V3d base, std::size_t i) const;

 private:
  struct Target {
    double weight;
    AccessorView displacements;
  };
  std::vector<Target> targets_;
};

/// The transforms of a primitive's vertices by the joints of a skin.
class SkinWeights {
 public:
  /// `source` is skinned. Throws SceneError if the skin lacks a joint.
  explicit SkinWeights(const Source& source);

  /// The mean of the joints' transforms with the weights of vertex `i`; that of the first joint if
  /// the vertex has no weights; not finite if the weights are not.
  M44d to_world(std::size_t i) const;
  /// Whether the transforms of most vertices are left-handed.
  bool mirrored() const { return 2 * mirrored_ > vertices_; }
  std::size_t without_weights() const { return without_weights_; }

 private:
  struct Set {
    AccessorView joints, weights;
  };
  std::vector<Set> sets_;
  const std::vector<M44d>& joints_;
  std::size_t vertices_ = 0, mirrored_ = 0, without_weights_ = 0;
};

/// The vertices of a primitive in the pose of its node: with the morph targets at their weights,
/// placed by the joints of its skin or else by the node.
class Vertices {
 public:
  explicit Vertices(const Source& source);

  std::size_t size() const { return positions_.size(); }
  /// In the mesh's coordinates.
  V3d local(std::size_t i) const;
  /// Whether the position, the displacements and the weights of vertex `i` are finite.
  bool finite(std::size_t i) const;
  /// In the coordinates of the world.
  V3d world(std::size_t i) const;
  /// Of unit length; 0 if it has no direction. The primitive has NORMAL.
  V3f world_normal(std::size_t i) const;

  /// `tangent`, in the mesh's coordinates, and in w the sign of its bitangent. Of unit length; 0
  /// if it has no direction.
  V4f world_tangent(std::size_t i, const V3d& tangent, float sign) const;

  /// Whether the winding of the triangles is reversed.
  bool mirrored() const;
  /// Whether world() applies one transform to all vertices of the file.
  bool rigid() const { return !skin_ && position_targets_.empty(); }
  const SkinWeights* skin() const { return skin_ ? &*skin_ : nullptr; }

 private:
  /// The matrix of cofactors of a transform, with the sign of its determinant: normals go with the
  /// inverse transpose, which is that over the determinant.
  struct NormalTransform {
    NormalTransform(const M44d& m, bool mirrored);
    V3d axes[3];
  };

  const Source& source_;
  AccessorView positions_;
  std::optional<AccessorView> normals_;
  MorphTargets position_targets_, normal_targets_;
  std::optional<SkinWeights> skin_;
  NormalTransform rigid_normals_;
};

}  // namespace lacuna::gltf
