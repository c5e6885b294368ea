#include "renderer/integrators/path_tracer.h"

#include "renderer/path/direct_light.h"
#include "renderer/path/emitter_selection.h"
#include "renderer/path/gathered_light.h"
#include "renderer/path/path_reuse.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/tiles.h"
#include "renderer/path/walk.h"

namespace lacuna {

namespace {

/// A contribution of next event estimation, pending its shadow ray.
struct Direct {
  Rgb value;
  std::uint32_t pixel;
  std::uint16_t path, depth;  // of the vertex
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
        reuse_(batch_, tracer.guide_, settings_.max_depth > 2 ? settings_.reuse : 1),
        walk_(context.scene, tracer.guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = settings_.roulette_depth,
               .split_depth = reuse_.active() ? 3 : 1,
               .packets = true},
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
    start_paths(context_, image_, block, batch_);
    tracer_.seen_.add(context_, block, counters_,
                      [&](std::size_t pixel, const Rgb& value) { add(pixel, value); });
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
    reuse_.finish(context_.scene.rays(), counters_,
                  [&](std::uint32_t pixel, const Rgb& value) { add(pixel, value); });
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
    if (!is_black(emission)) contribute(batch_.pixels[i], i, depth, 0, emission);
    const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
    if (!goes_on || !direct_.active() || !v.bsdf->connectible()) return;
    direct_.sample(v, depth, selection_.of(i), batch_.states[i].rng,
                   [&](const Ray& ray, const Rgb& value, const V3f& w) {
                     if (depth == 2) reuse_.set_next_event_direction(i, w);
                     shadows_.add(ray, {value, batch_.pixels[i], static_cast<std::uint16_t>(i),
                                        static_cast<std::uint16_t>(depth)});
                   });
  }

  /// Traces the queued shadow rays and adds the unoccluded contributions.
  void trace_shadows() {
    shadows_.flush(context_.scene.rays(), counters_,
                   [&](const Direct& d) { contribute(d.pixel, d.path, d.depth, 1, d.value); });
  }

  /// Adds `value`, of vertex `depth` of path `i` of `pixel` by the strategy `s`. All contributions
  /// but SeenEmission go through this function. Light from beyond vertex 2 goes to the pixels that
  /// share it, other light to `pixel`; the training samples get both.
  void contribute(std::size_t pixel, std::size_t i, int depth, int s, const Rgb& value) {
    const bool shared = depth + s > 2 && reuse_.shares(i);
    if (shared) {
      reuse_.add(i, depth, value);
    } else {
      add(pixel, value);
    }
    if (gathers_) gathered_.add(i, depth, shared ? value * reuse_.own(i) : value);
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
  EmitterSelection selection_;      // for next event estimation
  ShadowQueue<Direct> shadows_;     // contributions of next event estimation
  GatheredLight gathered_{batch_};  // for a guide that learns
  bool gathers_ = false;
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
      TilePass(*this, context, image, counters)
          .render(tiling.tile(i), pass, samples[static_cast<std::size_t>(i)]);
    });
    if (guide_.learns()) guide_.update(samples, pass, context, settings_.max_depth);
  }
  return sum;
}

}  // namespace lacuna
