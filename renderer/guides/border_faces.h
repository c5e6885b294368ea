#pragma once

#include "analysis/regions/borders.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/core/alias_table.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The faces of guide: face_irradiance: the whole border of a region, including the faces towards
/// surfaces and the outside. A face is sampled in proportion to the light that paths from the
/// region's surfaces found through it in all earlier iterations (Noel 2015, 10.4.2): the sum over
/// paths of radiance / pdf, which estimates the light that arrives through the face. RegionLattice
/// takes the place of the thesis' thresholds, by which a point may use its neighbour's border.
///
/// The thresholds are settings, too. A face that does not suit() the point, of a portal to a region
/// that has light, is replaced by a face of that region's border, drawn in its proportions. The
/// density of a face is the exact sum over both ways of drawing it:
///     P(f) = P_r(f) [f suits or leads to no such region] + sum_n P_n(f) Q_n,
/// Q_n the sum of P_r over the faces from r to n that do not suit. That is a loop over all lit
/// portal faces of the region at each density.
///
/// Where the settings name a region (`through`), all regions draw from its border (FIS3, FIS4).
class BorderFaceLight {
 public:
  static constexpr bool learns = true;
  /// Sample and count faces only where the ray leaves the region. The border includes faces in
  /// front of the surfaces around a point, which the point sees edge-on.
  static constexpr bool leaving_only = true;

  explicit BorderFaceLight(const FaceIrradianceGuideSettings& settings) : settings_(settings) {}
  void prepare(const PrepareContext& context, const SurfaceLookup&);
  void save(ByteWriter& out) const { out.put(light_); }
  /// Throws std::runtime_error if the state was saved for other borders.
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

  /// 1 where light was found through some face that the region draws; 0: nothing can be sampled.
  double mass(std::uint32_t region) const { return tables_[drawn_by(region)].empty() ? 0 : 1; }
  /// The bounds of the voxels on both sides of the region's border.
  const VoxelBox& box(std::uint32_t region) const { return boxes_[region]; }
  /// Draws a face for the point `from`, in voxels. Requires mass(region) above 0.
  VoxelFace draw(std::uint32_t region, const V3d& from, Rng& rng) const;
  /// The groups are the borders of regions: that of region r, drawn first, has the number r, and
  /// drawn in place of a face that does not suit `from` the number of regions more.
  void add_parts(std::uint32_t region, const V3d& from, double weight, FaceParts& parts) const;
  /// Probability of sampling `face`, through which the ray from `from` leaves region `near`.
  double probability(std::uint32_t part, const CrossedFace& face, std::uint32_t near,
                     std::uint32_t far, const V3d& from) const;

  /// Adds `light` >= 0 that was found through a face of the region's border.
  void add(std::uint32_t region, const VoxelFace& face, double light);
  /// Call after the last add() of the region.
  void update(std::uint32_t region) { make_table(region); }

 private:
  /// A face with light through it to another region, where there are thresholds.
  struct LitPortalFace {
    V3d centre;  // voxels
    int axis;
    std::uint32_t beyond;  // the other region
    double probability;
  };

  std::uint32_t drawn_by(std::uint32_t region) const { return through_.value_or(region); }
  std::uint64_t first(std::uint32_t region) const {
    return borders_.first[6 * std::size_t{region}];
  }
  /// Index of a face in its region's border.
  std::uint64_t index(std::uint32_t region, const VoxelFace& face) const;
  double probability(std::uint32_t region, const VoxelFace& face) const {
    return double(tables_[region].pmf(static_cast<std::uint32_t>(index(region, face))).value);
  }
  bool has_thresholds() const { return least_distance_ > 0 || settings_.least_cosine > 0; }
  /// Whether a face is kept for the point `from`, by the thresholds.
  bool suits(const V3d& centre, int axis, const V3d& from) const;
  V3d centre(const VoxelFace& face) const {
    return face.point(label_->voxel(face.voxel), 0.5, 0.5);
  }
  /// The region behind a face of a border; no_region: there is none.
  std::uint32_t beyond(const VoxelFace& face) const;
  /// Whether a face with this region behind it, drawn for `from`, is replaced by one of its border.
  bool is_replaced(const VoxelFace& face, std::uint32_t beyond, const V3d& from) const {
    return beyond != no_region && !tables_[beyond].empty() &&
           !suits(centre(face), face.axis(), from);
  }
  void make_table(std::uint32_t region);
  void find_lit_portal_faces(std::uint32_t region);

  FaceIrradianceGuideSettings settings_;
  double least_distance_ = 0;  // voxels
  std::optional<std::uint32_t> through_;
  const Grid3<std::uint32_t>* label_ = nullptr;
  Borders borders_;
  std::vector<double> light_;  // of each face of each region
  std::vector<AliasTable> tables_;
  std::vector<VoxelBox> boxes_;
  std::vector<std::vector<LitPortalFace>> lit_portal_faces_;  // of each region, by what is beyond
};

}  // namespace lacuna
