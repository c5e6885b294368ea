#pragma once

#include "analysis/regions/borders.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/core/alias_table.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The faces of guide: face_irradiance: the whole border of a region, including faces towards
/// surfaces and the outside. A face is sampled in proportion to the light that paths from the
/// region's surfaces gathered through it in all earlier iterations (Noel 2015, 10.4.2): the sum
/// over paths of radiance / pdf, an estimate of the light that arrives through the face.
/// RegionLattice replaces the thesis' thresholds by which a point may use its neighbour's border.
///
/// The thresholds are settings, too. If a sampled portal face to a region with light is not
/// suitable for the point (is_suitable()), a face of that region's border is sampled instead, from
/// its distribution. The probability of a face is the exact sum over both ways of sampling it:
///     P(f) = P_r(f) [f suitable, or not a face to such a region] + sum_n P_n(f) Q_n,
/// with Q_n the sum of P_r over the unsuitable faces from r to n. Each density therefore takes a
/// loop over all lit portal faces of the region.
///
/// With FacePaths::face, light does not come from eye paths: one path from each face, away from the
/// region, estimates it before each iteration, as in the thesis.
///
/// If the settings name a region (`through`), all regions sample its border (FIS3, FIS4).
class BorderFaceLight {
 public:
  static constexpr bool learns = true;
  /// Faces are sampled and counted only where the ray leaves the region. The border includes faces
  /// in front of the surfaces around a point, which the point sees edge-on.
  static constexpr bool leaving_only = true;

  explicit BorderFaceLight(const FaceIrradianceGuideSettings& settings) : settings_(settings) {}
  void prepare(const PrepareContext& context, const SurfaceLookup&);
  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if the state belongs to other borders.
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

  /// 1 if light arrived through some face of the border that the region samples; 0: nothing can be
  /// sampled.
  double mass(std::uint32_t region) const {
    return tables_[sampled_region(region)].empty() ? 0 : 1;
  }
  /// The bounds of the voxels on both sides of the region's border.
  const VoxelBox& box(std::uint32_t region) const { return boxes_[region]; }
  /// Samples a face for the point `from`, in voxels. Requires mass(region) above 0.
  VoxelFace sample_face(std::uint32_t region, const V3d& from, Rng& rng) const;
  /// Adds the groups of faces, which are borders of regions. The index of a group is r for the
  /// border of region r sampled directly, and r plus the number of regions if it replaces an
  /// unsuitable face.
  void add_parts(std::uint32_t region, const V3d& from, double weight, FaceParts& parts) const;
  /// Probability of sampling `face`, at which the ray from `from` leaves region `near`.
  double probability(std::uint32_t part, const CrossedFace& face, std::uint32_t near,
                     std::uint32_t far, const V3d& from) const;

  /// Adds `light` >= 0 that arrived through a face of the region's border.
  void add(std::uint32_t region, const VoxelFace& face, double light);
  bool learns_from_eye_paths() const { return settings_.learn_from == FacePaths::eye; }
  /// GuidingDistribution::begin(). `transform`: of the voxels.
  Counters begin(const IterationContext& context, int edges, const GridTransform& transform);
  /// Call after the last add() of the region.
  void update(std::uint32_t region) { make_table(region); }

 private:
  /// A portal face with light to another region, stored if there are thresholds.
  struct LitPortalFace {
    V3d centre;  // voxels
    int axis;
    std::uint32_t beyond;  // the other region
    double probability;
  };

  std::uint32_t sampled_region(std::uint32_t region) const { return through_.value_or(region); }
  std::uint64_t first(std::uint32_t region) const {
    return borders_.first[6 * std::size_t{region}];
  }
  /// Index of a face in its region's border.
  std::uint64_t index(std::uint32_t region, const VoxelFace& face) const;
  double probability(std::uint32_t region, const VoxelFace& face) const {
    return double(tables_[region].pmf(static_cast<std::uint32_t>(index(region, face))).value);
  }
  bool has_thresholds() const { return least_distance_ > 0 || settings_.least_cosine > 0; }
  /// Whether a face meets the thresholds for the point `from`.
  bool is_suitable(const V3d& centre, int axis, const V3d& from) const;
  V3d centre(const VoxelFace& face) const {
    return face.point(label_->voxel(face.voxel), 0.5, 0.5);
  }
  /// The region behind a face of a border, or no_region.
  std::uint32_t beyond(const VoxelFace& face) const;
  /// Whether a face to region `beyond`, sampled for `from`, is replaced by a face of its border.
  bool is_replaced(const VoxelFace& face, std::uint32_t beyond, const V3d& from) const {
    return beyond != no_region && !tables_[beyond].empty() &&
           !is_suitable(centre(face), face.axis(), from);
  }
  void make_table(std::uint32_t region);
  void find_lit_portal_faces(std::uint32_t region);

  FaceIrradianceGuideSettings settings_;
  double least_distance_ = 0;  // voxels
  std::optional<std::uint32_t> through_;
  const Grid3<std::uint32_t>* label_ = nullptr;
  Borders borders_;
  std::vector<double> light_;  // of each face of each region
  std::uint64_t begun_ = 0;    // 1 + the last iteration that begin() has added to light_
  std::vector<AliasTable> tables_;
  std::vector<VoxelBox> boxes_;
  std::vector<std::vector<LitPortalFace>> lit_portal_faces_;  // of each region, sorted by `beyond`
};

}  // namespace lacuna
