#pragma once

#include <unordered_map>

#include "analysis/regions/borders.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/core/alias_table.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The faces of guide: face_irradiance: the whole border of a region, including the faces towards
/// surfaces and the outside. A face is sampled in proportion to the light that paths from the
/// region's surfaces found through it in all earlier iterations (Noel 2015, 10.4.2): the sum over
/// paths of radiance / pdf, which estimates the light that arrives through the face. The thesis'
/// thresholds, by which a point may use its neighbour's border, are replaced by RegionLattice.
class BorderFaceLight {
 public:
  static constexpr bool learns = true;
  /// Sample and count faces only where the ray leaves the region. The border includes faces in
  /// front of the surfaces around a point, which the point sees edge-on.
  static constexpr bool leaving_only = true;

  explicit BorderFaceLight(const FaceIrradianceGuideSettings&) {}
  void prepare(const PrepareContext& context, const SurfaceLookup&);
  void save(ByteWriter& out) const { out.put(light_); }
  /// Throws std::runtime_error if the state was saved for other borders.
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

  /// 1 where light was found through some face of the region; 0: nothing can be sampled.
  double mass(std::uint32_t region) const { return tables_[region].empty() ? 0 : 1; }
  /// The bounds of the voxels on both sides of the region's border.
  const VoxelBox& box(std::uint32_t region) const { return boxes_[region]; }
  VoxelFace draw(std::uint32_t region, Rng& rng) const {
    return borders_.face(region, tables_[region].sample(rng));
  }
  void add_parts(std::uint32_t region, double weight, FaceParts& parts) const {
    parts.add(boxes_[region], region, weight);
  }
  /// Probability of sampling `face`, through which the ray leaves region `near`.
  double probability(std::uint32_t region, const CrossedFace& face, std::uint32_t near,
                     std::uint32_t) const {
    if (region != near) return 0;
    const VoxelFace own{static_cast<std::uint32_t>(label_->index(face.from)), face.side_of_from()};
    return double(tables_[region].pmf(static_cast<std::uint32_t>(index(region, own))).value);
  }

  struct Accumulator {
    std::unordered_map<std::uint64_t, double> light;  // by face, over all regions
  };
  void accumulate(std::uint32_t region, const VoxelFace& face, const GuidingSample& sample,
                  Accumulator& accumulator) const;
  void update(std::span<const Accumulator* const> accumulators, const ThreadPool& pool);

 private:
  std::uint64_t first(std::uint32_t region) const {
    return borders_.first[6 * std::size_t{region}];
  }
  /// Index of a face in its region's border.
  std::uint64_t index(std::uint32_t region, const VoxelFace& face) const;
  void make_table(std::uint32_t region);

  const Grid3<std::uint32_t>* label_ = nullptr;
  Borders borders_;
  std::vector<double> light_;  // of each face of each region
  std::vector<AliasTable> tables_;
  std::vector<VoxelBox> boxes_;
};

}  // namespace lacuna
