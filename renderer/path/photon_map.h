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

/// The radius of merging or density estimation in iteration `context.iteration`, scene units, > 0
/// (RadiusSettings).
double merge_radius(const RadiusSettings& settings, const IterationContext& context);

/// CPU seconds of all threads, by part of an iteration of a method with photons.
struct PhotonSeconds {
  double light = 0, grid = 0, eye = 0;
  double look_up = 0;  ///< a part of `eye`

  /// Appends them to the statistics of an integrator.
  void append_to(std::vector<std::pair<std::string, double>>& statistics) const;
};

/// The photons of an iteration. Keep it as a member of the integrator: it reuses its memory.
class PhotonMap {
 public:
  /// Call before the light pass, which traces `paths` light paths. Throws MemoryLimitError if there
  /// is no memory for one photon per path.
  void begin(std::int64_t paths);
  /// Stores vertex `v`, number `index` >= 1 of light path number `path`, if it can be merged. Call
  /// it for the paths of one part of a light pass in their order. Throws MemoryLimitError if there
  /// is no memory for the number of photons that the parts so far predict.
  void keep(std::size_t path, const Vertex& v, int index, bool caustic = false);
  /// keep() for all vertices of path `i` of `batch`, with the hits from which they are restored.
  void keep_path(std::size_t path, const LightBatch& batch, std::size_t i) {
    Part& part = parts_[path / std::size_t{paths_of_part}];
    batch.for_each_vertex(i, [&](std::size_t j, int s) {
      const std::size_t before = part.photons.size();
      keep(path, batch.vertex(j, s), s);
      if (part.photons.size() > before) part.hits.push_back(batch.hit(j, s));
    });
    part.ends.push_back(static_cast<std::uint32_t>(part.photons.size()));
  }
  /// Restores the path that keep_path() stored as path `i` of `batch`, without vertex 0.
  void restore_path(std::size_t path, LightBatch& batch, std::size_t i) const {
    const Part& part = parts_[path / std::size_t{paths_of_part}];
    const std::size_t k = path % std::size_t{paths_of_part};
    const std::size_t begin = k > 0 ? part.ends[k - 1] : 0, n = part.ends[k] - begin;
    batch.restore(i, std::span(part.photons).subspan(begin, n),
                  std::span(part.hits).subspan(begin, n));
  }
  /// Call after the light pass: builds the grid of for_each_at().
  void arrange(double radius, const ThreadPool& pool);
  /// Call after the light pass: builds the tree of for_each_nearest().
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

  /// Calls `visit(photon, d2)` for those of the k = found.size() - 1 photons nearest to eye vertex
  /// `v`, within the radius, that lie on one surface with it. Returns the squared radius of the
  /// disc for the density estimate: the squared distance to photon k + 1, since k / (pi r_{k+1}^2)
  /// is an unbiased estimate of a uniform density; with at most k photons within the radius, that
  /// of the map. `d2`: squared distance, in units of the disc's radius. `found`: working memory.
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
  /// The photons of one part of a light pass.
  struct Part {
    std::vector<Photon> photons;
    std::vector<Hit> hits;            ///< of each photon, if keep_path() stored it
    std::vector<std::uint32_t> ends;  ///< end of the photons of each path that keep_path() stored
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
