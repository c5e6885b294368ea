#pragma once

#include <algorithm>
#include <atomic>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "renderer/path/light_pass.h"
#include "renderer/path/merge.h"
#include "renderer/path/point_grid.h"
#include "renderer/path/point_tree.h"
#include "renderer/settings/photon_settings.h"

namespace lacuna {

/// The radius within which photons count in iteration `context.iteration`, scene units, > 0
/// (RadiusSettings).
double merge_radius(const RadiusSettings& settings, const IterationContext& context);

/// CPU seconds of all threads in the parts of the iterations of a method with photons.
struct PhotonSeconds {
  double light = 0, grid = 0, eye = 0;
  double look_up = 0;  ///< a part of `eye`

  /// Appends them to the statistics of an integrator.
  void append_to(std::vector<std::pair<std::string, double>>& statistics) const;
};

/// The photons of an iteration. A member of an integrator keeps its memory between iterations.
class PhotonMap {
 public:
  /// Before the light pass: room for the photons of `paths` light paths. Throws MemoryLimitError
  /// where one photon a path is too much.
  void begin(std::int64_t paths);
  /// Stores vertex `v`, number `index` >= 1 of light path number `path`, if it can be merged. To be
  /// called for the paths of one part of a light pass in their order. Throws MemoryLimitError where
  /// the photons so far let expect too many.
  void keep(std::size_t path, const Vertex& v, int index, bool caustic = false);
  /// Stores the photons of path `i` of `batch`, as keep(), and what restores its vertices.
  void keep_path(std::size_t path, const LightBatch& batch, std::size_t i) {
    Part& part = parts_[path / std::size_t{paths_of_part}];
    batch.for_each_vertex(i, [&](std::size_t j, int s) {
      const std::size_t before = part.photons.size();
      keep(path, batch.vertex(j, s), s);
      if (part.photons.size() > before) part.hits.push_back(batch.hit(j, s));
    });
    part.ends.push_back(static_cast<std::uint32_t>(part.photons.size()));
  }
  /// Makes path `i` of `batch` the path that keep_path() stored, without vertex 0.
  void restore_path(std::size_t path, LightBatch& batch, std::size_t i) const {
    const Part& part = parts_[path / std::size_t{paths_of_part}];
    const std::size_t k = path % std::size_t{paths_of_part};
    const std::size_t begin = k > 0 ? part.ends[k - 1] : 0, n = part.ends[k] - begin;
    batch.restore(i, std::span(part.photons).subspan(begin, n),
                  std::span(part.hits).subspan(begin, n));
  }
  /// After the light pass, for for_each_at().
  void arrange(double radius, const ThreadPool& pool);
  /// After the light pass, for for_each_nearest().
  void arrange_nearest(double radius, const ThreadPool& pool);

  std::size_t size() const { return photons_.size(); }
  /// Scene units.
  double radius() const { return radius_; }

  /// Calls `visit(photon, distance2, count)` for the photons within the radius of eye vertex `v`
  /// that lie on one surface with it (PointGrid::for_each_within).
  template <class Visit>
  void for_each_at(const Vertex& v, Rng& rng, Visit&& visit) const {
    grid_.for_each_within(v.surface.x, static_cast<float>(radius_), rng,
                          [&](std::uint32_t k, float distance2, float count) {
                            const Photon& p = photons_[k];
                            if (on_one_surface(v.surface.ng, p)) visit(p, distance2, count);
                          });
  }

  /// Calls `visit(photon, d2)` for the photons nearest to eye vertex `v` that lie on one surface
  /// with it: of the found.size() - 1 nearest within the radius. They lie in the disc up to the
  /// next one, whose squared radius is returned: k / (pi r_{k+1}^2) has the density's mean where
  /// that is uniform. The disc of fewer has the map's radius. `d2`: squared distance, in units of
  /// the disc's radius.
  template <class Visit>
  double for_each_nearest(const Vertex& v, std::span<PointTree::Found> found, Visit&& visit) const {
    const auto radius = static_cast<float>(radius_);
    double disc2 = radius_ * radius_;
    auto inside = found.first(tree_.nearest(v.surface.x, radius * radius, found));
    if (inside.size() == found.size()) {
      disc2 = std::max(double(found[0].distance2), disc2 * 0x1p-20);  // photons may be at one point
      inside = inside.subspan(1);
    }
    for (const auto& [distance2, index] : inside) {
      const Photon& p = photons_[index];
      if (on_one_surface(v.surface.ng, p)) visit(p, double(distance2) / disc2);
    }
    return disc2;
  }

 private:
  /// Of a light pass.
  struct Part {
    std::vector<Photon> photons;
    std::vector<Hit> hits;            ///< of keep_path(): of each photon
    std::vector<std::uint32_t> ends;  ///< of keep_path(): of each path, the end of its photons
  };

  void check_room() const;
  /// Calls `use(i, photon)` for all photons of the light pass, in order.
  template <class Use>
  void each_photon(const ThreadPool& pool, Use&& use) const;
  /// Sets positions_, in the order of the light pass.
  void place(double radius, const ThreadPool& pool);

  std::vector<Part> parts_;
  std::atomic<std::uint64_t> stored_ = 0;
  std::atomic<std::uint64_t> parts_begun_ = 0;
  HugeArray<V3f> positions_;
  HugeArray<Photon> photons_;  // in the order of the grid, or of the light pass
  HugeArray<std::uint32_t> places_;
  PointGrid grid_;
  PointTree tree_;
  double radius_ = 0;
};

}  // namespace lacuna
