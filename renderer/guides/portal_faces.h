#pragma once

#include "analysis/regions/portals.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The faces of guide: portals. From every region shortest paths lead to the regions where light
/// arrives; one portal on each is drawn by what arrives there over the path's length squared,
/// as skeleton guiding does (Noel 2015, eq. 164), and its faces alike (10.4.1, where there is one
/// light). What arrives in the region itself takes its share, and draws nothing.
class PortalFaces {
 public:
  static constexpr bool learns = false;
  static constexpr bool leaving_only = false;

  explicit PortalFaces(const PortalsGuideSettings& settings) : settings_(settings) {}

  void prepare(const PrepareContext& context, const SurfaceLookup& lookup);
  static void save(ByteWriter&) {}
  static void load(ByteReader&) {}
  std::vector<std::pair<std::string, double>> statistics() const;

  /// Share of the light that a region sees come from elsewhere, in [0, 1]; 0: nothing is drawn.
  double mass(std::uint32_t region) const { return exits_[region].mass; }
  void add_parts(std::uint32_t region, double weight, FaceParts& parts) const {
    for (const Exit& e : exits_[region].exits)
      parts.add(boxes_[e.portal], e.portal, weight * e.each);
  }
  VoxelFace draw(std::uint32_t region, Rng& rng) const;
  /// 1 of a face of `portal`, which lies between regions `near` and `far`.
  double probability(std::uint32_t portal, const CrossedFace&, std::uint32_t near,
                     std::uint32_t far) const {
    const Portal& p = portals_->portals[portal];
    return (p.a == near && p.b == far) || (p.a == far && p.b == near) ? 1 : 0;
  }

  struct Accumulator {};
  static void update(std::span<const Accumulator* const>, const ThreadPool&) {}

 private:
  struct Exit {
    std::uint32_t portal;
    double share;  // of the region's draws; all add up to 1
    double each;   // share of one face
  };
  struct Exits {
    std::vector<Exit> exits;
    double mass = 0;
  };

  void find_exits(std::uint32_t region, const std::vector<V3d>& centres,
                  const std::vector<double>& power, const RegionLabels& labels,
                  const std::function<bool(const Portal&)>& sees);

  PortalsGuideSettings settings_;
  const Portals* portals_ = nullptr;
  std::vector<V3d> middles_;     // of the portals, voxels
  std::vector<VoxelBox> boxes_;  // of the portals
  std::vector<Exits> exits_;     // of each region
};

}  // namespace lacuna
