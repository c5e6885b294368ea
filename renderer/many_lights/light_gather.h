#pragma once

#include <variant>

#include "renderer/many_lights/cluster_sampler.h"
#include "renderer/many_lights/lightcuts.h"
#include "renderer/many_lights/visibility_estimate.h"
#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/many_lights/vpl_sampler.h"
#include "renderer/path/contexts.h"
#include "renderer/path/shadow_queue.h"

namespace lacuna {

/// The summed contributions of virtual lights to a shading point.
struct LightSum {
  V3d value{0, 0, 0};
  std::uint64_t tests = 0;  ///< lights tested by a shadow ray
};

struct AllLights {};
/// The virtual lights to gather: all of them, or those that one of the pointers chooses.
struct GatheredLights {
  std::variant<AllLights, VplSampler*, const ClusterSampler*, const Lightcuts*> from = AllLights{};
  BlockRange range = {};  ///< only those of these blocks; the trees of cuts have no others
};

/// Sums the contributions of all virtual lights, or of the sampled ones, to the shading points of a
/// few pixels. The outer loop is over lights and the inner one over points, so a block of lights is
/// read from memory once for all points.
template <class Visibility>
class LightGather {
 public:
  LightGather(const IterationContext& context, const VplContributions& terms,
              const Visibility& visibility, const GatheredLights& gathered)
      : context_(context),
        terms_(terms),
        visibility_(visibility),
        gathered_(gathered),
        range_(gathered.range),
        by_length_(context.light) {}

  /// Writes the sum of `points[i]` to `sums[i]`, for at most Lanes::size points. Throws
  /// IterationStopped when the context's stop() returns true.
  void gather(std::span<const ShadingPoint> points, std::span<LightSum> sums, Counters& counters) {
    states_.clear();
    for (const ShadingPoint& p : points) states_.push_back(visibility_.at(p, context_));
    visibility_.share(points, std::span(states_), context_);
    if (by_length_) lengths_.assign(points.size() * length_count(), V3d(0));
    std::visit([&](const auto& from) { add(from, points, sums, counters); }, gathered_.from);
    flush(sums, counters);
  }

  /// Calls `use(edges, sum)` for the parts of the last sum of `point` by the edges between a light
  /// and its emitter, if the iteration has layers of light.
  template <class Use>
  void for_each_length(std::size_t point, Use&& use) const {
    if (!by_length_) return;
    for (std::size_t k = 0; k < length_count(); ++k) {
      use(static_cast<int>(k), lengths_[point * length_count() + k]);
    }
  }

 private:
  /// The contribution of a light that a shadow ray must test.
  struct PendingContribution {
    Rgb value;
    std::uint16_t point, edges;
    [[no_unique_address]] typename Visibility::Tested test;
  };
  struct Test {
    Ray ray;
    PendingContribution contribution;
  };
  static constexpr std::size_t largest_queue = 2048;  // rays, which fit the second-level cache
  static constexpr std::size_t blocks_between_stops = 64;

  void add(AllLights, std::span<const ShadingPoint> points, std::span<LightSum> sums,
           Counters& counters) {
    PointLanes lanes;
    std::array<std::size_t, Lanes::size> ends;  // end of the blocks whose lights reach each point
    std::size_t blocks = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      lanes.add(points[i]);
      ends[i] = terms_.lights().blocks(points[i].edges);
      blocks = std::max(blocks, ends[i]);
    }
    for (std::size_t b = range_.first; b < std::min(blocks, range_.end); ++b) {
      for_each_bit(terms_.may_light(b, lanes), [&](int bit) {
        const auto i = static_cast<std::size_t>(bit);
        if (b < ends[i]) add(points[i], {b, i, VplContributions::all_lights, 1}, sums[i], counters);
      });
      end_block(sums, counters);
    }
  }

  void add(VplSampler* sampler, std::span<const ShadingPoint> points, std::span<LightSum> sums,
           Counters& counters) {
    add_samples(sampler->sample(points, context_), points, sums, counters);
  }

  void add(const ClusterSampler* clusters, std::span<const ShadingPoint> points,
           std::span<LightSum> sums, Counters& counters) {
    cells_.clear();
    for (const auto& state : states_) cells_.push_back(visibility_.cell(state));
    const auto rate = [this](std::uint32_t c, std::size_t b) { return visibility_.rate(c, b); };
    add_samples(clusters->sample(points, context_, {cells_, rate}), points, sums, counters);
  }

  void add(const Lightcuts* cuts, std::span<const ShadingPoint> points, std::span<LightSum> sums,
           Counters& counters) {
    for (std::size_t i = 0; i < points.size(); ++i) add_cut(*cuts, points[i], i, sums[i], counters);
  }

  void add_samples(const std::vector<VplSampler::Sample>& samples,
                   std::span<const ShadingPoint> points, std::span<LightSum> sums,
                   Counters& counters) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const VplSampler::Sample& s = samples[k];
      if (!range_.contains(s.block)) continue;
      add(points[s.point], s, sums[s.point], counters);
      if (k + 1 == samples.size() || samples[k + 1].block != s.block) end_block(sums, counters);
    }
  }

  void add_cut(const Lightcuts& cuts, const ShadingPoint& at, std::size_t point, LightSum& sum,
               Counters& counters) {
    const auto cut = cuts.cut(at, [&](std::size_t block, int i, float weight) {
      return traced(at, {block, point, std::uint64_t{1} << i, weight}, sum, counters);
    });
    for (const Lightcuts::Entry& e : cut) {
      sum.value += e.value;
      if (by_length_) length(point, cuts.edges(e)) += e.value;
    }
    if (context_.stop()) throw IterationStopped{};
  }

  /// The contribution of one light, whose shadow ray is traced at once.
  V3d traced(const ShadingPoint& at, const VplSampler::Sample& sample, LightSum& sum,
             Counters& counters) {
    typename Visibility::At& state = states_[sample.point];
    const int i = std::countr_zero(sample.lights);
    if (visibility_.hides(state, sample.block)) return V3d(0);
    terms_.evaluate(at, sample.block, term_, sample.lights, sample.weight);
    counters.rejected += static_cast<std::uint64_t>(__builtin_popcountll(term_.rejected));
    if (term_.lit == 0) return V3d(0);
    visibility_.decide(state, sample.block, term_, decision_);
    float v = decision_.untested[i];
    if (decision_.tests != 0) {
      ++counters.shadow_rays, ++sum.tests;
      if (!context_.scene.rays().occluded(terms_.ray(at, sample.block, i))) {
        visibility_.seen(state, visibility_.tested(state, i));
        v += decision_.gain[i];
      }
    }
    return V3d(Rgb(term_.r[i], term_.g[i], term_.b[i])) * double(v);
  }

  void end_block(std::span<LightSum> sums, Counters& counters) {
    queue_tests();
    if (queue_.size() >= largest_queue) flush(sums, counters);
    if (++blocks_ % blocks_between_stops == 0 && context_.stop()) throw IterationStopped{};
  }

  void add(const ShadingPoint& at, const VplSampler::Sample& sample, LightSum& sum,
           Counters& counters) {
    const std::size_t block = sample.block;
    typename Visibility::At& state = states_[sample.point];
    if (visibility_.hides(state, block)) return;
    terms_.evaluate(at, block, term_, sample.lights, sample.weight);
    counters.rejected += static_cast<std::uint64_t>(__builtin_popcountll(term_.rejected));
    if (term_.lit == 0) return;
    visibility_.decide(state, block, term_, decision_);
    const V3d untested(double(sum_of_products(term_.r, decision_.untested)),
                       double(sum_of_products(term_.g, decision_.untested)),
                       double(sum_of_products(term_.b, decision_.untested)));
    sum.value += untested;
    const int edges = by_length_ ? terms_.lights().edges(block) : 0;
    if (by_length_) length(sample.point, edges) += untested;
    for_each_bit(decision_.tests, [&](int i) {
      tests_[static_cast<std::size_t>(i)].push_back(
          {terms_.ray(at, block, i),
           {Rgb(term_.r[i], term_.g[i], term_.b[i]) * decision_.gain[i],
            static_cast<std::uint16_t>(sample.point), static_cast<std::uint16_t>(edges),
            visibility_.tested(state, i)}});
    });
    sum.tests += static_cast<std::uint64_t>(__builtin_popcountll(decision_.tests));
  }

  /// Queues the shadow rays by light: rays from one light to neighbouring points are coherent.
  void queue_tests() {
    for (auto& of_light : tests_) {
      for (const Test& t : of_light) queue_.add(t.ray, t.contribution);
      of_light.clear();
    }
  }

  void flush(std::span<LightSum> sums, Counters& counters) {
    queue_.flush(context_.scene.rays(), counters, [&](const PendingContribution& l) {
      sums[l.point].value += V3d(l.value);
      if (by_length_) length(l.point, l.edges) += V3d(l.value);
      visibility_.seen(states_[l.point], l.test);
    });
  }

  std::size_t length_count() const { return terms_.lights().lengths(); }
  V3d& length(std::size_t point, int edges) {
    return lengths_[point * length_count() + static_cast<std::size_t>(edges)];
  }

  const IterationContext& context_;
  const VplContributions& terms_;
  const Visibility& visibility_;
  GatheredLights gathered_;
  BlockRange range_;
  bool by_length_;
  std::vector<V3d> lengths_;  // of each point, the sums by the edges of its lights
  std::size_t blocks_ = 0;    // processed
  std::vector<typename Visibility::At> states_;       // of each point
  std::vector<std::uint32_t> cells_;                  // of each point
  std::array<std::vector<Test>, Lanes::size> tests_;  // of each light of the block
  ShadowQueue<PendingContribution> queue_;
  Terms term_;
  VisibilityEstimate decision_;
};

}  // namespace lacuna
