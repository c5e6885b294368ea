#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "renderer/path/connect.h"
#include "renderer/path/eye_batch.h"

namespace lacuna {

/// Path reuse (Bekaert, Sbert and Halton 2002): pixels of a group share the light that arrives at
/// vertex 2 of their paths. Vertex 2 of each path is connected to vertex 1 of every other by a
/// shadow ray. A path from vertex 1 of pixel i over vertex 2 of pixel j could have been sampled by
/// each pixel k whose vertex 1 sees that vertex 2, so its weight by the balance heuristic is
///
///     P_jj F_jj / sum_k V_kj P_kj F_kj.
///
/// P_kj is the density per area of vertex 2 of j on the walk of k, V_kj the visibility, and F_kj
/// the luminance of what vertex 2 scatters from the light to vertex 1 of k: a glossy vertex 2 gives
/// little weight to pixels that see another part of its lobes. The estimate is unbiased. Emission
/// at vertex 2 and next event estimation at vertex 1 are not shared.
///
/// Requires that roulette ends no path before vertex 2 and that no path is split before vertex 3:
/// vertices 1 and 2 must stay unchanged until all branches of the batch have ended.
class PathReuse {
 public:
  /// `pixels`: of a group, at most EyeBatch::size; 1: no reuse. `batch` and `guide` must outlive
  /// this.
  /// `by_length`: keeps the light of each path length apart, for finish().
  PathReuse(EyeBatch& batch, const Guide& guide, int pixels, bool by_length = false)
      : batch_(batch),
        guide_(guide),
        pixels_(static_cast<std::size_t>(pixels)),
        far_of_length_(by_length && pixels > 1 ? batch.stride * EyeBatch::size : 0) {}

  /// Whether pixels share light at all. If not, no path shares().
  bool active() const { return pixels_ > 1; }

  /// Call when the batch's paths have started, not when branches resume. `rng` selects the groups:
  /// at random, so that neighbouring pixels seldom have correlated noise, and the same in all
  /// iterations, so that a pixel's low-discrepancy sequence integrates one function.
  void begin(Rng rng) {
    if (!active()) return;
    shares_.fill(false);
    paths_ = batch_.states.size();
    pixel_of_ = batch_.pixels;
    std::iota(order_.begin(), order_.end(), std::uint8_t{0});
    for (std::size_t i = paths_; i > 1 && pixels_ < paths_; --i) {
      std::swap(order_[i - 1], order_[rng.below(i)]);
    }
  }

  /// Call when path `i` has reached vertex `depth`, before next event estimation there. Decides at
  /// vertex 2 whether the path shares(), and then resets its throughput to 1.
  void reach(std::size_t i, int depth) {
    if (!active()) return;
    if (depth == 2) begin_sharing(i);
    if (depth == 3) to_next_[i] = -batch_.vertex(i, 3).wp;
  }
  /// Whether contributions of path `i` by next event estimation at vertex 2, and at later vertices,
  /// go to add() instead of its pixel.
  bool shares(std::size_t i) const { return shares_[batch_.origin[i]]; }
  /// The throughput of path `i` up to vertex 2, which values of add() lack; 1 if it does not share.
  Rgb own(std::size_t i) const { return shares(i) ? carried_[batch_.origin[i]] : Rgb(1, 1, 1); }
  /// Sets the unit direction `w` of next event estimation at vertex 2 of path `i`.
  void set_next_event_direction(std::size_t i, const V3f& w) { to_emitter_[i] = w; }
  /// Adds a contribution of path `i`, of `edges` edges: of next event estimation at vertex 2, or of
  /// a later vertex.
  void add(std::size_t i, int depth, int edges, const Rgb& value) {
    if (is_finite(value)) {
      (depth == 2 ? near_ : far_)[batch_.origin[i]] += value;
      if (depth > 2 && !far_of_length_.empty()) far_of_length(batch_.origin[i], edges) += value;
    } else {
      ++rejected_;
    }
  }

  /// Multiplies the throughput of the vertices of finished paths by own(), for training samples.
  /// Also changes it before the vertex at which a branch began, where it is not read any more.
  void restore_throughput() {
    for (std::size_t i = 0; i < batch_.states.size(); ++i) {
      if (!shares(i)) continue;
      for (int d = 2; d <= batch_.states[i].depth; ++d) batch_.vertex(i, d).throughput *= own(i);
    }
  }

  /// Calls `add(pixel, value)` with the shared light and, by length, `add_part(pixel, edges,
  /// value)` with its parts. Requires that the paths and their branches have ended and all their
  /// shadow rays are traced.
  template <class Add, class AddPart>
  void finish(const RayCaster& caster, Counters& counters, Add&& add, AddPart&& add_part) {
    if (!active()) return;
    counters.rejected += std::exchange(rejected_, 0);
    for (std::size_t first = 0; first < paths_; first += pixels_) {
      const auto group = std::span(order_).subspan(first, std::min(pixels_, paths_ - first));
      for (const std::size_t j : group) {
        if (!shares_[j]) continue;
        const Vertex& v = batch_.vertex(j, 2);
        // A delta lobe of vertex 2 scatters to no other pixel.
        if (v.delta) {
          add(pixel_of_[j], carried_[j] * std::exchange(far_[j], Rgb(0, 0, 0)));
          for_each_length(j, [&](int edges, Rgb& far) {
            add_part(pixel_of_[j], edges, carried_[j] * std::exchange(far, Rgb(0, 0, 0)));
          });
        }
        if (is_black(near_[j]) && is_black(far_[j])) continue;
        connect_to_group(j, group);
        trace(caster, counters);
        distribute(j, add, add_part);
      }
    }
  }

 private:
  /// f |cos| of vertex 2 towards a vertex 1: for light from the point of next event estimation
  /// (near) and for light from vertex 3 (far).
  struct Scattered {
    Rgb near{0, 0, 0}, far{0, 0, 0};
  };
  /// The edge between vertex 1 of a path k and vertex 2 of path j.
  struct Edge {
    std::uint32_t pixel = 0;
    bool visible = true;
    double density = 0;  ///< P_kj
    /// Contribution to the pixel of radiance 1 from vertex 2: throughput f |cos| |cos| / d^2.
    Rgb carried{0, 0, 0};
    Scattered scattered = {};
  };

  void begin_sharing(std::size_t i) {
    const Vertex& first = batch_.vertex(i, 1);
    Vertex& v = batch_.vertex(i, 2);
    if (!is_connectible_surface(first) || first.delta || !is_connectible_surface(v)) return;
    PathState& state = batch_.states[i];
    carried_[i] = v.throughput;
    state.throughput = v.throughput = Rgb(1, 1, 1);
    // Roulette and splitting still use the throughput of the whole path.
    state.roulette.carried_before = max_component(carried_[i]);
    shares_[i] = true;
    near_[i] = far_[i] = Rgb(0, 0, 0);
    for_each_length(i, [](int, Rgb& far) { far = Rgb(0, 0, 0); });
  }
  Rgb& far_of_length(std::size_t i, int edges) {
    return far_of_length_[i * batch_.stride + static_cast<std::size_t>(edges)];
  }
  /// Calls `use(edges, far)` for the parts of far_[i] by length, if they are kept.
  template <class Use>
  void for_each_length(std::size_t i, Use&& use) {
    if (far_of_length_.empty()) return;
    for (int edges = 3; edges < static_cast<int>(batch_.stride); ++edges) {
      use(edges, far_of_length(i, edges));
    }
  }
  static bool is_connectible_surface(const Vertex& v) {
    return v.kind == Vertex::Kind::surface && v.bsdf && v.bsdf->connectible();
  }

  /// Sets edges_ to those from vertex 2 of path `j` to vertex 1 of all paths of its group, its own
  /// first, and rays_ to the shadow rays of the others.
  void connect_to_group(std::size_t j, std::span<const std::uint8_t> group) {
    const Vertex& v = batch_.vertex(j, 2);
    // The walk's throughput is f |cos| / p.
    const double p = double(v.p_fwd.value);
    const Scattered own = scattered(j, v.wp);
    edges_.assign(1, {pixel_of_[j], true, p, carried_[j] * static_cast<float>(p), own});
    rays_.clear();
    const VertexPlace to{v};
    for (const std::size_t k : group) {
      const Vertex& first = batch_.vertex(k, 1);
      if (k == j || !is_connectible_surface(first)) continue;
      const SurfaceEndpoint from{first, 1, Transport::radiance, guide_};
      const Connection c = edge_between(from, to);
      if (!(c.distance2 > 0)) continue;
      Pdf<SolidAngle> bsdf;
      const Rgb value = from.scatter(c.w, bsdf);
      // If nothing is scattered, scatter() may leave `bsdf` at 0.
      const double density = is_black(value) ? from.pdf(c.w) : from.pdf(c.w, bsdf);
      if (!(density > 0)) continue;
      Edge e{.pixel = pixel_of_[k]};
      if (!v.bsdf->is_constant_in_wo(v.wp, -c.w)) {
        e.scattered = scattered(j, -c.w);
        if (is_black(e.scattered.near) && is_black(e.scattered.far)) continue;
      } else {
        e.scattered = own;
      }
      const double area = double(abs_dot(v.surface.ng, c.w)) / double(c.distance2);
      e.density = density * area;
      e.carried = value * static_cast<float>(area);
      e.carried *= transmittance(from, to, c);
      edges_.push_back(e);
      // From vertex 2: the rays have one origin, which makes them coherent.
      const V3f origin = to.origin(-c.w);
      rays_.push_back({origin, from.end(c.w, c.distance) - origin, 1.0F});
    }
  }

  Scattered scattered(std::size_t j, const V3f& wo) const {
    const Vertex& v = batch_.vertex(j, 2);
    Scattered s;
    if (!is_black(near_[j])) s.near = v.bsdf->eval(wo, to_emitter_[j], Transport::radiance);
    if (!is_black(far_[j])) {
      s.far = v.bsdf->eval(wo, to_next_[j], Transport::radiance);
    }
    return s;
  }

  void trace(const RayCaster& caster, Counters& counters) {
    counters.shadow_rays += rays_.size();
    occluded_.resize(rays_.size());
    caster.occluded_together(rays_, occluded_);
    for (std::size_t k = 0; k < rays_.size(); ++k) edges_[k + 1].visible = occluded_[k] == 0;
  }

  template <class Add, class AddPart>
  void distribute(std::size_t j, Add&& add, AddPart&& add_part) {
    double sum_near = 0, sum_far = 0;
    for (const Edge& e : edges_) {
      if (!e.visible) continue;
      sum_near += e.density * double(luminance(e.scattered.near));
      sum_far += e.density * double(luminance(e.scattered.far));
    }
    // The gathered light without the factor f |cos| of vertex 2 towards the path's own pixel.
    const Scattered& own = edges_[0].scattered;
    const Rgb near = over(near_[j], own.near, sum_near), far = over(far_[j], own.far, sum_far);
    for (const Edge& e : edges_) {
      if (e.visible) add(e.pixel, e.carried * (e.scattered.near * near + e.scattered.far * far));
    }
    if (far_of_length_.empty()) return;
    for (const Edge& e : edges_) {
      if (e.visible) add_part(e.pixel, 3, e.carried * (e.scattered.near * near));
    }
    for_each_length(j, [&](int edges, const Rgb& gathered) {
      if (is_black(gathered)) return;
      const Rgb part = over(gathered, own.far, sum_far);
      for (const Edge& e : edges_) {
        if (e.visible) add_part(e.pixel, edges, e.carried * (e.scattered.far * part));
      }
    });
  }
  /// gathered / scattered, times luminance(scattered) / sum. `sum`: of P_kj F_kj, visible edges.
  static Rgb over(const Rgb& gathered, const Rgb& scattered, double sum) {
    if (!(sum > 0)) return Rgb(0, 0, 0);
    const double share = double(luminance(scattered)) / sum;
    const auto channel = [&](float g, float s) {
      return s > 0 ? static_cast<float>(double(g) / double(s) * share) : 0.0F;
    };
    return {channel(gathered.x, scattered.x), channel(gathered.y, scattered.y),
            channel(gathered.z, scattered.z)};
  }

  EyeBatch& batch_;
  const Guide& guide_;
  std::size_t pixels_;
  std::size_t paths_ = 0;
  std::uint64_t rejected_ = 0;  // values that were not finite
  std::array<std::uint32_t, EyeBatch::size> pixel_of_{};
  std::array<std::uint8_t, EyeBatch::size> order_{};  // of paths: `pixels_` in a row are a group
  std::array<bool, EyeBatch::size> shares_{};
  std::array<Rgb, EyeBatch::size> carried_{};  // throughput up to vertex 2
  std::array<Rgb, EyeBatch::size> near_{}, far_{};
  std::vector<Rgb> far_of_length_;  // far_ by the edges of whole paths; empty: not wanted
  std::array<V3f, EyeBatch::size> to_emitter_{}, to_next_{};  // unit, from vertex 2
  std::vector<Edge> edges_;                                   // of one vertex 2
  std::vector<Ray> rays_;                                     // of edges_ but the first
  std::vector<std::uint8_t> occluded_;
};

}  // namespace lacuna
