#pragma once

#include "renderer/guides/gathered_light.h"
#include "renderer/integrators/guided_integrator.h"
#include "renderer/path/direct_light.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/next_event_batch.h"
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

  bool renders_parts() const override { return true; }

  SceneNeeds needs() const override {
    SceneNeeds needs = GuidedIntegrator<Guide>::needs();
    needs.light_tree =
        settings_.next_event_estimation && settings_.emitters != EmitterChoice::power;
    return needs;
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    const Tiling tiling(context, image);
    std::vector<typename Guide::Accumulator> accumulators(static_cast<std::size_t>(tiling.tiles()));
    const Counters sum = for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
      render(context, image, tiling.tile(i), counters, accumulators[static_cast<std::size_t>(i)]);
    });
    if (guide_.learns()) guide_.update(accumulators, context.pool);
    return sum;
  }

 private:
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
    GatheredLight gathered{*this};  // for a guide that learns
  };

  void render(const IterationContext& context, Image& image, const Tile& tile, Counters& counters,
              typename Guide::Accumulator& accumulator) const {
    const bool learns = guide_.learns();
    if (learns) accumulator = guide_.accumulator();
    Batch batch(settings_.max_depth);
    Walk walk(context.scene, guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = settings_.roulette_depth,
               .packets = true},
              counters);
    const auto flush = [&] {
      batch.shadows.flush(context.scene.rays(), counters, [&](const Direct& d) {
        accumulate(image.pixels[d.pixel], d.value, counters);
        if (learns) batch.gathered.add(d.path, d.depth, d.value);
      });
    };
    for (int b = 0; b < tile.blocks(); ++b) {
      start_paths(context, image, tile.block(b), batch);
      counters.samples += batch.states.size();
      do {
        if (learns) batch.gathered.clear();
        estimate(context.scene, walk, batch);
        for (std::size_t i = 0; i < batch.states.size(); ++i) {
          accumulate(image.pixels[batch.pixels[i]], batch.radiance[i], counters);
        }
        if (learns) {
          flush();
          batch.gathered.record(guide_, accumulator);
        }
        batch.store(walk.branches());
      } while (batch.resume());
    }
    flush();
  }

  /// One sample of each pixel of `batch`, into its `radiance` and `shadows`.
  void estimate(const Scene& scene, Walk<Guide>& walk, Batch& batch) const {
    const DirectLight<Guide> direct(scene, guide_, settings_.next_event_estimation,
                                    settings_.emitters);
    const auto choose_emitter = [&](std::size_t i, int depth) {
      if (direct.draws() && depth < settings_.max_depth) {
        batch.ahead[i] = direct.choose_ahead(batch.states[i].rng);
      }
    };
    const auto gather = [&](std::size_t i, int depth) {
      const Vertex& v = batch.vertex(i, depth);
      const Rgb met = direct.met(v, batch.vertex(i, depth - 1), depth);
      batch.radiance[i] += met;
      if (guide_.learns()) {
        batch.gathered.reach(i, depth);
        batch.gathered.add(i, depth, met);
      }
      const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
      if (goes_on && direct.draws() && v.bsdf->connectible()) {
        direct.draw(v, depth, batch.ahead[i], batch.states[i].rng,
                    [&](const Ray& ray, const Rgb& value) {
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
};

}  // namespace lacuna
