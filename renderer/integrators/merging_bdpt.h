#pragma once

#include "renderer/integrators/bdpt.h"
#include "renderer/path/photon_map.h"
#include "renderer/settings/photon_settings.h"

namespace lacuna {

/// The techniques beside those of bidirectional path tracing.
struct Merging {
  bool merge = false;   ///< merge eye vertices with the vertices of all light paths (mis.h)
  bool connect = true;  ///< use all strategies (s, t), else s = 0 only
  RadiusSettings radius = {};
};

/// Bidirectional path tracing that can also merge: vertex connection and merging (Georgiev et al.
/// 2012), whatever selects the light vertices for connections.
class MergingBdpt : public Bdpt {
 public:
  MergingBdpt(const BdptSettings& settings, Guide guide, const Merging& merging)
      : Bdpt(settings, std::move(guide)), merging_(merging) {}

  std::vector<std::pair<std::string, double>> statistics() const override {
    auto stats = Bdpt::statistics();
    if (!merging_.merge) return stats;
    stats.emplace_back("photons", static_cast<double>(photons_.size()));
    stats.emplace_back("radius", photons_.radius());
    return stats;
  }

 protected:
  /// The eye vertices of a batch whose photons are looked up.
  struct LookUps {
    struct At {
      std::uint32_t path;
      int depth;
    };
    std::vector<At> all;
    double seconds = 0;  ///< CPU time of look_up()
    SparseStop stop = {};
    void add(std::size_t path, int depth) {
      all.push_back({static_cast<std::uint32_t>(path), depth});
    }
  };

  /// Prepares for the photons of `paths` light paths. Returns SampleCounts::merge; 0 without
  /// merging.
  double begin_merging(const IterationContext& context, std::int64_t paths) {
    if (!merging_.merge) return 0;
    radius_ = merge_radius(merging_.radius, context);
    photons_.begin(paths);
    return static_cast<double>(paths) * std::numbers::pi * radius_ * radius_;
  }
  /// Call after the light pass, which has filled photons_.
  void arrange_photons(const IterationContext& context) { photons_.arrange(radius_, context.pool); }

  /// Merges the eye vertices of the batch with the photons around them.
  void look_up(const TilePass& pass, EyePaths& batch, LookUps& look_ups) const;

  Merging merging_;
  PhotonMap photons_;

 private:
  double radius_ = 0;
};

}  // namespace lacuna
