#pragma once

#include "analysis/regions/portals.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The faces of guide: portals. Shortest paths lead from every region to the regions at which light
/// arrives. One portal on each path is sampled with weight f / d^2, with f the power that arrives
/// in the region at its end and d its length, as in skeleton guiding (Noel 2015, eq. 164); the
/// faces of a portal have equal probability (10.4.1, for one light). Power that arrives in the
/// region itself lowers the region's mass(). With PortalPaths::light_region, one path of each
/// region leads to the light's region, and has mass() 1. If the settings name a portal (`through`),
/// all regions use only that portal, with mass() 1 (SIS3 and SIS4).
class PortalFaces {
 public:
  static constexpr bool learns = false;
  static constexpr bool leaving_only = false;

  explicit PortalFaces(const PortalsGuideSettings& settings) : settings_(settings) {}

  void prepare(const PrepareContext& context, const SurfaceLookup& lookup);
  static void save(ByteWriter&) {}
  static void load(ByteReader&) {}
  std::vector<std::pair<std::string, double>> statistics() const;

  /// Fraction of a region's light that comes from other regions, in [0, 1]; 0: nothing is sampled.
  double mass(std::uint32_t region) const { return exits_[region].mass; }
  void add_parts(std::uint32_t region, const V3d&, double weight, FaceParts& parts) const {
    for (const Exit& e : exits_[region].exits)
      parts.add(boxes_[e.portal], e.portal, weight * e.each);
  }
  VoxelFace sample_face(std::uint32_t region, const V3d& from, Rng& rng) const;
  /// 1 for a face of `portal`, that is, between its regions `near` and `far`; else 0.
  double probability(std::uint32_t portal, const CrossedFace&, std::uint32_t near,
                     std::uint32_t far, const V3d&) const {
    const Portal& p = portals_->portals[portal];
    return (p.a == near && p.b == far) || (p.a == far && p.b == near) ? 1 : 0;
  }

 private:
  struct Exit {
    std::uint32_t portal;
    double share;  // probability of the portal; the sum over a region's exits is 1
    double each;   // probability of one of its faces
  };
  struct Exits {
    std::vector<Exit> exits;
    double mass = 0;
  };

  void find_all_exits(const PrepareContext& context, const SurfaceLookup& lookup);

  PortalsGuideSettings settings_;
  const Portals* portals_ = nullptr;
  double voxel_size_ = 0;        // scene units
  std::vector<V3d> middles_;     // of the portals, voxels
  std::vector<VoxelBox> boxes_;  // of the portals
  std::vector<Exits> exits_;     // of each region
};

}  // namespace lacuna
