#pragma once

#include "renderer/integrators/guided_integrator.h"
#include "renderer/integrators/one_ray.h"
#include "renderer/integrators/strategy_layers.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/gathered_light.h"
#include "renderer/path/light_batch.h"
#include "renderer/path/tiles.h"
#include "renderer/settings/bdpt_settings.h"

namespace lacuna {

/// A contribution of a strategy to a pixel of the tile.
struct BdptContribution {
  std::uint8_t path = 0;          ///< index of the eye path in its batch
  std::uint8_t distribution = 0;  ///< VertexSample::distribution
  PathMatches matches = 0;
  float survival = 1;          ///< probability of making the connection; `value` is divided by it
  float throughput = 0;        ///< luminance of the eye vertex' throughput
  std::uint32_t cell = 0;      ///< of the eye vertex, for CellStatistics
  Rgb value{0, 0, 0};          ///< unweighted
  float weight = 0;            ///< MIS
  std::uint16_t s = 0, t = 0;  ///< vertices sampled from the light and from the eye
  std::uint32_t traced = 0;    ///< number of the path in the observer; 0: none
};

/// Bidirectional path tracing (Noel 2015, 4.3 and ch. 11), except for the selection of the light
/// vertices that an eye vertex is connected to.
class Bdpt : public GuidedIntegrator {
 public:
  Bdpt(const BdptSettings& settings, Guide guide)
      : GuidedIntegrator(std::move(guide)), settings_(settings) {}

 protected:
  using GuidedIntegrator::guide_;

  struct EyePaths : EyeBatch {
    EyePaths(int max_depth, const SampleCounts& n, const IterationContext& of)
        : EyeBatch(max_depth), context(of), counts(n), letters(of.light.automaton()) {
      keep_whole_paths(of.observer != nullptr);
    }
    bool is_observed(std::size_t path) const {
      return context.observer != nullptr && context.observer->watches(pixels[path]);
    }
    const IterationContext& context;
    SampleCounts counts;
    const PathAutomaton* letters;
    GatheredLight gathered{*this};  // for a guide that learns
    bool gathers = false;
    ShadowQueue<BdptContribution> queue;  // of connections
    std::optional<OneRay<BdptContribution>> one_ray;
  };
  /// The arguments that all functions of a tile's pass share.
  struct TilePass {
    const IterationContext& context;
    Image& image;
    Counters& counters;
  };

  /// Adds `value`, weighted, of vertex `depth` of path `i` to its pixel and for the guide. All
  /// contributions but splats go through this function.
  void contribute(const TilePass& pass, EyePaths& batch, std::size_t i, int depth,
                  const Rgb& value) const {
    accumulate(pass.image.pixels[batch.pixels[i]], value, pass.counters);
    if (batch.gathers) batch.gathered.add(i, depth, value);
  }
  /// The same for a strategy of the pyramid (StrategyLayers): also fills its layer.
  void contribute(const TilePass& pass, EyePaths& batch, const BdptContribution& c) const {
    const Rgb value = c.value * c.weight;
    contribute(pass, batch, c.path, c.t - 1, value);
    pass.context.light.add(batch.pixels[c.path], c.s + c.t - 1, c.matches, value);
    if (c.traced != 0) pass.context.observer->arrived(c.traced, value);
    layers_.strategy(pass.context.layers, c.s, c.t, {batch.pixels[c.path], c.value, c.weight});
  }

  /// Adds the emission at a vertex of an eye path (s = 0).
  void add_hit(const TilePass& pass, EyePaths& batch, std::size_t i, int depth,
               const NextEvent& next_event) const {
    if (batch.gathers) batch.gathered.reach(i, depth);
    const Vertex& v = batch.vertex(i, depth);
    std::optional<EmitterPoint> e = emitter_at(pass.context.scene, v);
    if (!e) return;
    if (batch.counts.nee > 0) {
      next_event.set_ratio(*e, v, batch.vertex(i, depth - 1), depth);
    }
    BdptContribution hit{
        .path = static_cast<std::uint8_t>(i),
        .matches = matches_at_hit(batch.letters, v),
        .value = v.throughput * e->emission,
        .weight = static_cast<float>(hit_weight(v, depth, *e, batch.counts, guide_)),
        .t = static_cast<std::uint16_t>(depth + 1)};
    if (batch.is_observed(i)) hit.traced = observe(batch, hit, {});
    contribute(pass, batch, hit);
  }

  /// Shows the observer a contribution before its shadow ray is traced. `from_light`: the vertices
  /// sampled from the light.
  [[gnu::cold]] static std::uint32_t observe(const EyePaths& batch, const BdptContribution& c,
                                             std::span<const Vertex* const> from_light) {
    return batch.context.observer->add(
        {.iteration = batch.context.iteration, .s = c.s, .t = c.t, .weight = c.weight},
        batch.path_to(c.path, c.t - 1), from_light);
  }

  /// Largest s of connections to an eye vertex `depth` edges from the eye; 0: none.
  int longest_light_path(const Vertex& v, int depth) const {
    if (v.kind != Vertex::Kind::surface || depth >= settings_.max_depth) return 0;
    return v.bsdf->connectible() ? settings_.max_depth - depth : 0;
  }

  /// Connects `eye` and `light` and queues the contribution, divided by `samples`: the expected
  /// number of samples of this light vertex. `known`: the members of the contribution that do not
  /// follow from the connection. `from_light()`: the vertices of a light path, for the observer.
  template <class Light, class FromLight = std::vector<const Vertex*> (*)()>
  static void queue_connection(
      const SurfaceEndpoint& eye, const Light& light, double samples, BdptContribution known,
      EyePaths& batch, FromLight&& from_light = [] { return std::vector<const Vertex*>{}; }) {
    const Connection c = connect(eye, light);
    if (!c) return;
    known.value = c.contribution / static_cast<float>(samples);
    known.weight = static_cast<float>(weight(eye, light, c, batch.counts));
    known.s = static_cast<std::uint16_t>(light.index + 1);
    known.t = static_cast<std::uint16_t>(eye.index + 1);
    known.matches = matches_between(batch.letters, eye, light, c.w);
    if (batch.is_observed(known.path)) [[unlikely]] {
      if constexpr (std::is_same_v<Light, EmitterEndpoint>) {
        const Vertex emitter = next_event_vertex(light.e);
        known.traced = observe(batch, known, std::array{&emitter});
      } else {
        known.traced = observe(batch, known, from_light());
      }
    }
    const Ray ray = shadow_ray(eye, light, c);
    batch.one_ray ? batch.one_ray->add(ray, known, batch.queue) : batch.queue.add(ray, known);
  }

  /// Traces the queued shadow rays of `batch`, adds the unoccluded contributions, and calls
  /// `arrived(contribution)` for each.
  template <class Arrived>
  void flush(const TilePass& pass, EyePaths& batch, Arrived&& arrived) const {
    const IterationContext& context = pass.context;
    batch.queue.flush(
        context.scene.rays(), pass.counters,
        [&](const BdptContribution& c) {
          contribute(pass, batch, c);
          arrived(c);
          layers_.distribution(context.layers, c.distribution, batch.pixels[c.path],
                               c.value * c.weight);
        },
        [&] { context.check_stop(); });
  }
  /// flush() if the queue takes much memory, while the paths of the batch continue: two paths of a
  /// thousand edges have a million connections.
  template <class Arrived>
  void flush_if_long(const TilePass& pass, EyePaths& batch, Arrived&& arrived) const {
    constexpr std::size_t many = 1 << 17;
    if (batch.queue.size() >= many) flush(pass, batch, arrived);
  }
  /// Adds the queued connections of the batch, and records samples for the guide.
  template <class Arrived>
  void finish(const TilePass& pass, EyePaths& batch, TrainingSamples::Part& samples,
              Arrived&& arrived) const {
    if (batch.one_ray) batch.one_ray->finish(batch.queue);
    flush(pass, batch, arrived);
    if (batch.gathers) batch.gathered.record(samples);
  }
  /// Starts the paths of a Tile::block(), and counts them.
  void start(const TilePass& pass, const Tile& block, EyePaths& batch) const {
    start_paths(pass.context, pass.image, block, batch);
    pass.counters.samples += batch.states.size();
    batch.gathers = guide_.learns_from(block.pixel(0), pass.context, settings_.max_depth);
    if (batch.gathers) batch.gathered.clear();
  }
  /// Continues with the branches of the paths; false if there are none left.
  bool resume(Walk& walk, EyePaths& batch) const {
    batch.store(walk.branches());
    if (!batch.resume()) return false;
    if (batch.gathers) batch.gathered.clear();
    return true;
  }
  void update_guide(const IterationContext& context,
                    std::span<const TrainingSamples::Part> samples) {
    if (guide_.learns()) guide_.update(samples, {}, context, settings_.max_depth);
  }
  /// The callback of for_each_splatting_part() that adds splats to the layers.
  auto splat_layers(const IterationContext& context) const {
    return [this, &context](const Splat& s) {
      layers_.strategy(context.layers, s.s, 1, {s.pixel, s.value, s.weight});
    };
  }

  LightPathSetting light_setting(const IterationContext& context,
                                 const SampleCounts& counts) const {
    return {.scene = context.scene,
            .camera = context.camera,
            .max_depth = settings_.max_depth,
            .roulette_depth = settings_.roulette_depth,
            .counts = counts,
            .letters = context.light.automaton(),
            .observer = context.observer,
            .iteration = context.iteration};
  }
  WalkLimits eye_limits(const IterationContext& context, const SampleCounts& counts) const {
    return {.max_depth = settings_.max_depth,
            .roulette_depth = settings_.roulette_depth,
            .packets = true,
            .counts = eye_side(counts),
            .letters = context.light.automaton()};
  }
  static std::int64_t pixels(const Image& image) {
    return std::int64_t{image.width} * image.height;
  }
  BdptSettings settings_;
  StrategyLayers layers_;
};

}  // namespace lacuna
