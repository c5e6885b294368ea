#include "renderer/integrators/path_tracer.h"

#include "renderer/path/direct_light.h"
#include "renderer/path/emitter_selection.h"
#include "renderer/path/gathered_light.h"
#include "renderer/path/path_matches.h"
#include "renderer/path/path_observer.h"
#include "renderer/path/path_reuse.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/tiles.h"
#include "renderer/path/walk.h"

namespace lacuna {

namespace {

/// A contribution to a pixel: of an emitter that the path hits, or of next event estimation,
/// pending its shadow ray.
struct Contribution {
  Rgb value;
  std::uint32_t pixel;
  std::uint8_t path;  // of the vertex
  PathMatches matches;
  std::uint16_t depth;       // of the vertex
  std::uint32_t traced = 0;  // number of the path in the observer; 0: none
};

}  // namespace

PathTracer::PathTracer(const PathSettings& settings, Guide guide)
    : GuidedIntegrator(std::move(guide)), settings_(settings) {}

SceneNeeds PathTracer::needs() const {
  SceneNeeds needs = GuidedIntegrator::needs();
  needs.light_tree = settings_.next_event_estimation && settings_.emitters != EmitterChoice::power;
  return needs;
}

void PathTracer::prepare(const PrepareContext& context) {
  GuidedIntegrator::prepare(context);
  seen_.prepare(context);
}

/// Renders the paths of a tile.
class PathTracer::TilePass {
 public:
  TilePass(const PathTracer& tracer, const IterationContext& context, Image& image,
           Counters& counters)
      : tracer_(tracer),
        settings_(tracer.settings_),
        context_(context),
        image_(image),
        counters_(counters),
        direct_(context.scene, tracer.guide_, settings_.next_event_estimation, settings_.emitters,
                settings_.heuristic),
        batch_(settings_.max_depth),
        selection_(direct_.next_event(), direct_.active(), settings_.max_depth, batch_),
        reuse_(batch_, tracer.guide_, settings_.max_depth > 2 ? settings_.reuse : 1,
               bool(context.light)),
        walk_(context.scene, tracer.guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = settings_.roulette_depth,
               .split_depth = reuse_.active() ? 3 : 1,
               .packets = true,
               .letters = context.light.automaton()},
              counters) {}

  void render(const Tile& tile, const LearningPass& pass, TrainingSamples::Part& samples) {
    for (int b = 0; b < tile.blocks(); ++b) {
      const Tile block = tile.block(b);
      if (pass.renders(block.first.x, block.first.y)) render_block(block, samples);
    }
    trace_shadows();
  }

 private:
  /// Traces one path for each pixel, with its branches.
  void render_block(const Tile& block, TrainingSamples::Part& samples) {
    batch_.keep_whole_paths(context_.observer != nullptr);
    start_paths(context_, image_, block, batch_);
    tracer_.seen_.add(context_, block, counters_, [&](std::size_t pixel, const Rgb& value) {
      add(pixel, value);
      context_.light.add_seen(pixel, value);
      if (is_observed(pixel)) context_.observer->arrived(observe_seen(value));
    });
    counters_.samples += batch_.states.size();
    const bool learns = tracer_.guide_.learns_from(block.pixel(0), context_, settings_.max_depth);
    if (learns && !gathers_) trace_shadows();  // the queued ones belong to earlier paths
    gathers_ = learns;
    reuse_.begin(Rng(context_.seed, 0, batch_.pixels[0], Rng::Purpose::groups));
    do {
      if (gathers_) gathered_.clear();
      trace_paths();
      if (gathers_ || reuse_.active()) trace_shadows();
      if (gathers_) {
        reuse_.restore_throughput();
        gathered_.record(samples);
      }
      batch_.store(walk_.branches());
    } while (batch_.resume());
    reuse_.finish(
        context_.scene.rays(), counters_,
        [&](std::uint32_t pixel, const Rgb& value) { add(pixel, value); },
        [&](std::uint32_t pixel, int edges, const Rgb& value) {
          context_.light.add(pixel, edges, 0, value);
        });
  }

  /// Traces the paths of the batch. trace_shadows() adds the light of next event estimation.
  void trace_paths() {
    walk_.trace_paths(
        batch_.states, [this](std::size_t i, int depth) { visit(i, depth); }, selection_);
  }

  /// Adds emission at vertex `depth` of path `i`, and queues next event estimation there.
  void visit(std::size_t i, int depth) {
    const Vertex& v = batch_.vertex(i, depth);
    const bool apart = depth == 1 && tracer_.seen_.rays(batch_.pixels[i]) > 0;
    const Rgb emission = apart ? Rgb(0, 0, 0) : direct_.hit(v, batch_.vertex(i, depth - 1), depth);
    reuse_.reach(i, depth);
    if (gathers_) gathered_.reach(i, depth);
    if (!is_black(emission)) {
      Contribution c = contribution(i, depth, emission);
      if (marks_) [[unlikely]]
        mark_hit(c);
      contribute(c, 0);
    }
    const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
    if (!goes_on || !direct_.active() || !v.bsdf->connectible()) return;
    direct_.sample(v, depth, selection_.of(i), batch_.states[i].rng,
                   [&](const Ray& ray, const Rgb& value, const DirectLight::Sample& to) {
                     if (depth == 2) reuse_.set_next_event_direction(i, to.w);
                     Contribution c = contribution(i, depth, value);
                     if (marks_) [[unlikely]]
                       mark_next_event(c, to);
                     shadows_.add(ray, c);
                   });
  }

  Contribution contribution(std::size_t i, int depth, const Rgb& value) const {
    return {value, batch_.pixels[i], static_cast<std::uint8_t>(i), 0,
            static_cast<std::uint16_t>(depth)};
  }

  /// Traces the queued shadow rays and adds the unoccluded contributions.
  void trace_shadows() {
    shadows_.flush(context_.scene.rays(), counters_,
                   [&](const Contribution& c) { contribute(c, 1); });
  }

  /// Adds a contribution of strategy `s`. All but those of SeenEmission go through this function.
  /// Light from beyond vertex 2 goes to the pixels that share it, other light to the path's own;
  /// the training samples get both.
  void contribute(const Contribution& c, int s) {
    const bool shared = c.depth + s > 2 && reuse_.shares(c.path);
    if (shared) {
      reuse_.add(c.path, c.depth, c.depth + s, c.value);
    } else {
      add(c.pixel, c.value);
      if (marks_) [[unlikely]]
        arrive(c, s);
    }
    if (gathers_) gathered_.add(c.path, c.depth, shared ? c.value * reuse_.own(c.path) : c.value);
  }

  bool is_observed(std::size_t pixel) const {
    return context_.observer != nullptr && context_.observer->watches(pixel);
  }
  // Not inline: few jobs have layers of light or an observer, and all contributions pass
  // here.
  [[gnu::noinline, gnu::cold]] void mark_hit(Contribution& c) const {
    const Vertex& v = batch_.vertex(c.path, c.depth);
    c.matches = matches_at_hit(context_.light.automaton(), v);
    if (!is_observed(c.pixel)) return;
    const Rgb whole = v.throughput * emitter_at(context_.scene, v)->emission;
    c.traced = observe(c, 0, luminance(c.value) / luminance(whole), {});
  }
  [[gnu::noinline, gnu::cold]] void mark_next_event(Contribution& c,
                                                    const DirectLight::Sample& to) const {
    const Vertex& v = batch_.vertex(c.path, c.depth);
    const SurfaceEndpoint eye{v, c.depth, Transport::radiance, tracer_.guide_};
    c.matches = matches_beyond(context_.light.automaton(), eye, to.w);
    if (!is_observed(c.pixel)) return;
    const Vertex light = next_event_vertex(to.point);
    c.traced = observe(c, 1, to.weight, std::array{&light});
  }
  [[gnu::noinline, gnu::cold]] void arrive(const Contribution& c, int s) const {
    context_.light.add(c.pixel, c.depth + s, c.matches, c.value);
    if (c.traced != 0) context_.observer->arrived(c.traced);
  }
  std::uint32_t observe(const Contribution& c, int s, float weight,
                        std::span<const Vertex* const> from_light) const {
    return context_.observer->add({.iteration = context_.iteration,
                                   .s = s,
                                   .t = c.depth + 1,
                                   .value = c.value,
                                   .weight = weight},
                                  batch_.path_to(c.path, c.depth), from_light);
  }
  std::uint32_t observe_seen(const Rgb& value) const {
    return context_.observer->add({context_.iteration, 0, 2, value, 1}, {}, {});
  }

  void add(std::size_t pixel, const Rgb& value) {
    accumulate(image_.pixels[pixel], value, counters_);
  }

  const PathTracer& tracer_;
  const PathSettings& settings_;
  const IterationContext& context_;
  Image& image_;
  Counters& counters_;
  DirectLight direct_;
  EyeBatch batch_;
  EmitterSelection selection_;         // for next event estimation
  ShadowQueue<Contribution> shadows_;  // contributions of next event estimation
  GatheredLight gathered_{batch_};     // for a guide that learns
  bool gathers_ = false;
  const bool marks_ = bool(context_.light) || context_.observer != nullptr;
  PathReuse reuse_;
  Walk walk_;
};

Counters PathTracer::iterate(const IterationContext& context, Image& image) {
  Counters counters = guide_.begin(context, settings_.max_depth);
  if (guide_.first_pass().end == LearningPass::parts) {
    return counters += render_passes(context, image);
  }
  // The first iteration updates the guide between its passes: a stopped one must restore it.
  ByteWriter before;
  guide_.save(before);
  try {
    return counters += render_passes(context, image);
  } catch (...) {
    ByteReader in(before.bytes());
    guide_.load(in);
    throw;
  }
}

Counters PathTracer::render_passes(const IterationContext& context, Image& image) {
  const WorkSection section(context.pool, "eye paths");
  const Tiling tiling(image);
  Counters sum;
  for (LearningPass pass = guide_.first_pass(); pass.first < LearningPass::parts;
       pass = pass.next()) {
    std::vector<TrainingSamples::Part> samples(static_cast<std::size_t>(tiling.tiles()));
    sum += for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
      if (context.observer != nullptr && !guide_.learns()) {
        const int pixel = static_cast<int>(context.observer->pixel());
        if (!tiling.tile(i).contains({pixel % image.width, pixel / image.width})) return;
      }
      TilePass(*this, context, image, counters)
          .render(tiling.tile(i), pass, samples[static_cast<std::size_t>(i)]);
    });
    if (guide_.learns()) guide_.update(samples, pass, context, settings_.max_depth);
  }
  return sum;
}

}  // namespace lacuna
