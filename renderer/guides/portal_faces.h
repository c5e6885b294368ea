#pragma once

#include "analysis/regions/portals.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/guides/directions.h"
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
  /// All faces that it draws, with the voxels on both sides.
  const VoxelBox& box(std::uint32_t region) const { return exits_[region].box; }
  VoxelFace draw(std::uint32_t region, Rng& rng) const;
  /// Of a face between regions `near` and `far`.
  double probability(std::uint32_t region, const CrossedFace&, std::uint32_t near,
                     std::uint32_t far) const {
    for (const Exit& e : exits_[region].exits) {
      if ((e.a == near && e.b == far) || (e.a == far && e.b == near)) return e.each;
    }
    return 0;
  }

  struct Tally {};
  static void end(std::span<const Tally* const>, const ThreadPool&) {}

 private:
  struct Exit {
    std::uint32_t portal;
    std::uint32_t a, b;  // the regions on its sides
    double share;        // of the region's draws; all add up to 1
    double each;         // share of one face
  };
  struct Exits {
    std::vector<Exit> exits;
    double mass = 0;
    VoxelBox box;
  };

  void find_exits(std::uint32_t region, const std::vector<V3d>& centres,
                  const std::vector<double>& power, const RegionLabels& labels,
                  const std::function<bool(const Portal&)>& sees);

  PortalsGuideSettings settings_;
  const Portals* portals_ = nullptr;
  std::vector<V3d> middles_;  // of the portals, voxels
  std::vector<Exits> exits_;  // of each region
};

}  // namespace lacuna
