#pragma once

#include <optional>
#include <utility>

#include "renderer/guides/efficiency_roulette.h"
#include "renderer/guides/gathered_light.h"
#include "renderer/guides/learning_memory.h"
#include "renderer/guides/path_trees.h"
#include "renderer/integrators/guided_integrator.h"
#include "renderer/integrators/seen_emission.h"
#include "renderer/path/direct_light.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/next_event_batch.h"
#include "renderer/path/path_reuse.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/tiles.h"
#include "renderer/path/walk.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

/// Path tracing (Noel 2015, 4.2): the strategies s = 0, an emitter hit by the walk, and s = 1, next
/// event estimation at every vertex, weighted against each other.
template <class Guide>
class PathTracer final : public GuidedIntegrator<Guide> {
  using GuidedIntegrator<Guide>::guide_;

 public:
  PathTracer(const PathSettings& settings, Guide guide)
      : GuidedIntegrator<Guide>(std::move(guide)), settings_(settings) {}

  SceneNeeds needs() const override {
    SceneNeeds needs = GuidedIntegrator<Guide>::needs();
    needs.light_tree =
        settings_.next_event_estimation && settings_.emitters != EmitterChoice::power;
    return needs;
  }

  void prepare(const PrepareContext& context) override {
    GuidedIntegrator<Guide>::prepare(context);
    seen_.prepare(context);
    if (settings_.roulette == RouletteChoice::efficiency) {
      roulette_.emplace(context.scene,
                        std::size_t(context.camera.width()) * std::size_t(context.camera.height()));
    }
  }
  std::vector<std::pair<std::string, double>> statistics() const override {
    auto all = GuidedIntegrator<Guide>::statistics();
    if (roulette_) {
      for (const auto& row : roulette_->statistics()) all.push_back(row);
    }
    return all;
  }
  void save(ByteWriter& out) const override {
    GuidedIntegrator<Guide>::save(out);
    if constexpr (Guide::has_expected) out.put(pilots_);
    if (roulette_) roulette_->save(out);
  }
  void load(ByteReader& in) override {
    GuidedIntegrator<Guide>::load(in);
    if constexpr (Guide::has_expected) pilots_ = in.get<Counters>();
    if (roulette_) roulette_->load(in);
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    render_pilots(context, image);
    const Tiling tiling(image);
    const auto tiles = static_cast<std::size_t>(tiling.tiles());
    std::vector<typename Guide::Accumulator> accumulators(tiles);
    const bool observes = roulette_ && roulette_->observes();
    std::vector<EfficiencyRoulette::Accumulator> continuations(
        observes && roulette_->learns() ? tiles : 0);
    LearningMemory memory(tiles);
    Counters sum = for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
      const auto k = static_cast<std::size_t>(i);
      render(context, image, tiling.tile(i), counters,
             {accumulators[k], continuations.empty() ? nullptr : &continuations[k]},
             settings_.max_depth > 2 ? settings_.reuse : 1);
      memory.add(accumulators[k].bytes());
    });
    if (guide_.learns()) guide_.update(accumulators, context.pool, 1);
    if (observes) roulette_->update(continuations, context, image, sum);
    sum += std::exchange(pilots_, {});
    return sum;
  }

 private:
  /// Renders the pilots that the guide asks for before this iteration. One that has finished stays
  /// learned if the iteration is stopped: pilots depend on nothing but those before them.
  void render_pilots(const IterationContext& context, const Image& image) {
    if constexpr (Guide::has_expected) {
      Image scratch;  // thrown away
      while (const std::optional<std::uint64_t> number = guide_.due_pilot()) {
        if (scratch.pixels.empty()) scratch = Image(image.width, image.height);
        guide_.begin_pilot();
        pilots_ += render_pilot(context, scratch, *number);
      }
    }
  }
  /// One block of each tile, in a large picture of some of them: what a pilot tells depends on how
  /// many pixels it has, not on how many there are. Two pilots after each other, one with the guide
  /// and one without, have the same blocks.
  Counters render_pilot(IterationContext context, Image& scratch, std::uint64_t number) {
    constexpr int enough_tiles = 24;
    context.layers = {};
    // Numbers of no iteration, whatever the sampler.
    context.sampler = Sampler::sobol;
    context.sample = SampleNumber{SampleNumber::of_pilots, number};
    const Tiling tiling(scratch);
    const int apart = std::max(1, tiling.tiles() / enough_tiles);
    const int turn = static_cast<int>((number + 1) / 2 % (std::uint64_t{1} << 16));
    // Multiples of the golden ratio modulo 1 are spread evenly, however many tiles there are.
    const std::uint64_t fraction = static_cast<std::uint32_t>(turn) * 0x9E3779B9U;
    const int first = static_cast<int>(fraction * static_cast<std::uint64_t>(apart) >> 32);
    const int tiles = (tiling.tiles() - first + apart - 1) / apart;
    std::vector<typename Guide::Accumulator> accumulators(static_cast<std::size_t>(tiles));
    const Counters sum = for_each_part(context, tiles, [&](int i, Counters& counters) {
      const Tile tile = tiling.tile(first + i * apart);
      render(context, scratch, tile.block(7 * turn % tile.blocks()), counters,
             {accumulators[static_cast<std::size_t>(i)], nullptr}, 1);
    });
    guide_.update(accumulators, context.pool, double(sum.samples) / double(scratch.pixels.size()));
    return sum;
  }

  /// A contribution of next event estimation, pending its shadow ray.
  struct Direct {
    Rgb value;
    std::uint32_t pixel;
    std::uint16_t path, depth;  // of the vertex
  };

  struct Batch : EyeBatch {
    using EyeBatch::EyeBatch;
    EmittersAhead ahead{};          // the emitters of next event estimation
    ShadowQueue<Direct> shadows;    // and what they give
    GatheredLight gathered{*this};  // for what learns
    bool gathers = false;
    bool grows = false;  // `trees`
    PathTrees trees;     // for roulette
  };

  /// What is learned from a part of an iteration.
  struct Learning {
    typename Guide::Accumulator& guide;
    EfficiencyRoulette::Accumulator* roulette;  // null: it does not learn
  };

  /// `sharing`: pixels that share light (PathSettings::reuse); 1 for pilots, which only teach.
  void render(const IterationContext& context, Image& image, const Tile& tile, Counters& counters,
              Learning learning, int sharing) const {
    if (guide_.learns()) learning.guide = guide_.accumulator();
    const bool decides = roulette_ && roulette_->active();
    const bool early = roulette_ && roulette_->ends_early();
    Batch batch(settings_.max_depth);
    PathReuse<Guide> reuse(batch, guide_, sharing);
    Walk walk(context.scene, guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = early ? std::min(settings_.roulette_depth, early_roulette_depth)
                                       : settings_.roulette_depth,
               .split_depth = reuse.active() ? 3 : 1,
               .packets = true,
               .roulette = decides ? &*roulette_ : nullptr},
              counters);
    const auto flush = [&] {
      batch.shadows.flush(context.scene.rays(), counters, [&](const Direct& d) {
        const bool shared = d.depth >= 2 && reuse.shares(d.path);
        if (shared) {
          reuse.add(d.path, d.depth, d.value);
        } else {
          accumulate(image.pixels[d.pixel], d.value, counters);
        }
        if (batch.gathers) {
          batch.gathered.add(d.path, d.depth, shared ? d.value * reuse.own(d.path) : d.value);
        }
      });
    };
    for (int b = 0; b < tile.blocks(); ++b) {
      start_paths(context, image, tile.block(b), batch);
      seen_.add(context, tile.block(b), counters, [&](std::size_t pixel, const Rgb& value) {
        accumulate(image.pixels[pixel], value, counters);
      });
      counters.samples += batch.states.size();
      const bool grows = learning.roulette != nullptr &&
                         roulette_->learns_from(batch.pixels[0], context.iteration);
      // What waits for its shadow rays is of other paths.
      if (grows && !batch.gathers) flush();
      batch.grows = grows;
      batch.gathers = grows || guide_.learns();
      reuse.begin(Rng(context.seed, 0, batch.pixels[0], Rng::Purpose::groups));
      do {
        if (batch.gathers) batch.gathered.clear();
        if (batch.grows) batch.trees.begin(batch.states);
        estimate(context, walk, batch, reuse);
        for (std::size_t i = 0; i < batch.states.size(); ++i) {
          accumulate(image.pixels[batch.pixels[i]], batch.radiance[i], counters);
        }
        if (batch.gathers || reuse.active()) flush();
        if (batch.gathers) {
          reuse.restore_throughput();
          if (guide_.learns()) batch.gathered.record(guide_, learning.guide);
          if (batch.grows) collect(batch);
        }
        batch.store(walk.branches());
      } while (batch.resume());
      reuse.finish(context.scene.rays(), counters, [&](std::uint32_t pixel, const Rgb& value) {
        accumulate(image.pixels[pixel], value, counters);
      });
      if (batch.grows) {
        batch.trees.record([&](std::uint32_t key, double value, double rays) {
          learning.roulette->push_back({key, static_cast<float>(rays), value});
        });
      }
    }
    flush();
  }

  void collect(Batch& batch) const {
    batch.trees.collect(batch, batch.gathered, [&](const Vertex& v, int depth) {
      return roulette_->key(v, settings_.max_depth - depth);
    });
  }

  /// One sample of each pixel of `batch`, into its `radiance` and `shadows`.
  void estimate(const IterationContext& context, Walk<Guide>& walk, Batch& batch,
                PathReuse<Guide>& reuse) const {
    const DirectLight<Guide> direct(context.scene, guide_, settings_.next_event_estimation,
                                    settings_.emitters);
    const auto choose_emitter = [&](std::size_t i, int depth) {
      if (direct.draws() && depth < settings_.max_depth) {
        batch.ahead[i] = direct.choose_ahead(batch.states[i].rng);
      }
    };
    const auto gather = [&](std::size_t i, int depth) {
      const Vertex& v = batch.vertex(i, depth);
      const bool apart = depth == 1 && seen_.rays(batch.pixels[i]) > 0;
      const Rgb met = apart ? Rgb(0, 0, 0) : direct.met(v, batch.vertex(i, depth - 1), depth);
      const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
      const bool shared = depth > 2 && reuse.shares(i);
      if (shared) {
        reuse.add(i, depth, met);
      } else {
        batch.radiance[i] += met;
      }
      reuse.reach(i, depth);
      if (batch.gathers) {
        batch.gathered.reach(i, depth);
        batch.gathered.add(i, depth, shared ? met * reuse.own(i) : met);
      }
      if (goes_on && direct.draws() && v.bsdf->connectible()) {
        direct.draw(v, depth, batch.ahead[i], batch.states[i].rng,
                    [&](const Ray& ray, const Rgb& value, const V3f& w) {
                      if (depth == 2) reuse.look(i, w);
                      if (batch.gathers) batch.gathered.cast(i, depth);
                      batch.shadows.add(ray, {value, batch.pixels[i], static_cast<std::uint16_t>(i),
                                              static_cast<std::uint16_t>(depth)});
                    });
      }
    };
    walk.trace_paths(batch.states, choose_emitter, gather,
                     SelectTogether(direct.next_event(), direct.draws(), settings_.max_depth, batch,
                                    batch.ahead));
  }

  PathSettings settings_;
  SeenEmission seen_;
  std::optional<EfficiencyRoulette> roulette_;
  Counters pilots_;  // of those since the last iteration that was finished
};

}  // namespace lacuna
