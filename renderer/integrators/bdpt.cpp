#include "renderer/integrators/integrators.h"

#include "renderer/connections/registry.h"
#include "renderer/core/pass_seconds.h"
#include "renderer/guides/gathered_light.h"
#include "renderer/guides/make_guide.h"
#include "renderer/integrators/guided_integrator.h"
#include "renderer/integrators/strategy_layers.h"
#include "renderer/path/light_pass.h"
#include "renderer/path/next_event_batch.h"
#include "renderer/path/photon_map.h"
#include "renderer/settings/bdpt_settings.h"
#include "renderer/settings/connections_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/vcm_settings.h"

namespace lacuna {

namespace {

/// A contribution of a strategy to a pixel of the tile, pending its shadow ray.
struct Contribution {
  std::uint32_t pixel = 0;
  std::uint8_t path = 0;  ///< of the eye's path, in its batch
  std::uint8_t distribution = 0;
  float survival = 1;          ///< probability of making the connection; `value` is divided by it
  float throughput = 0;        ///< luminance of the eye vertex' throughput
  std::uint32_t cell = 0;      ///< of the eye vertex, for CellStatistics
  Rgb value{0, 0, 0};          ///< unweighted
  float weight = 0;            ///< MIS
  std::uint16_t s = 0, t = 0;  ///< vertices sampled from the light and from the eye
};

/// Bidirectional path tracing (Noel 2015, 4.3 and ch. 11), apart from the choice of the light
/// vertices that an eye vertex is connected to.
template <class Guide>
class Bdpt : public GuidedIntegrator<Guide> {
 public:
  Bdpt(const BdptSettings& settings, Guide guide)
      : GuidedIntegrator<Guide>(std::move(guide)), settings_(settings) {}

 protected:
  using GuidedIntegrator<Guide>::guide_;

  struct EyePaths : EyeBatch {
    EyePaths(int max_depth, const SampleCounts& n) : EyeBatch(max_depth), counts(n) {}
    SampleCounts counts;
    GatheredLight gathered{*this};  // for a guide that learns
    ShadowQueue<Contribution> queue;
  };
  /// What the parts of a tile's work share.
  struct TilePass {
    const IterationContext& context;
    Image& image;
    Counters& counters;
  };

  /// Adds the emission at a vertex of an eye path (s = 0).
  void gather_hit(const IterationContext& context, EyePaths& batch, std::size_t i, int depth,
                  const NextEvent& next_event) const {
    if (guide_.learns()) batch.gathered.reach(i, depth);
    const Vertex& v = batch.vertex(i, depth);
    std::optional<EmitterPoint> e = emitter_at(context.scene, v);
    if (!e) return;
    if (batch.counts.nee > 0) {
      next_event.set_ratio(*e, v, batch.vertex(i, depth - 1), depth);
    }
    const Rgb value = v.throughput * e->emission;
    const auto w = static_cast<float>(hit_weight(v, depth, *e, batch.counts, guide_));
    batch.radiance[i] += value * w;
    if (guide_.learns()) batch.gathered.add(i, depth, value * w);
    layers_.strategy(context.layers, 0, depth + 1, {batch.pixels[i], value, w});
  }

  /// Largest s of connections to an eye vertex `depth` edges from the eye; 0: none.
  int longest_light_path(const Vertex& v, int depth) const {
    if (v.kind != Vertex::Kind::surface || depth >= settings_.max_depth) return 0;
    return v.bsdf->connectible() ? settings_.max_depth - depth : 0;
  }

  /// Connects `eye` and `light` and queues the contribution, over `samples`: the expected number of
  /// samples of this light vertex. What the connection does not determine is as in `known`.
  template <class Light>
  static void join(const SurfaceEndpoint<Guide>& eye, const Light& light, double samples,
                   Contribution known, EyePaths& batch) {
    const Connection c = connect(eye, light);
    if (!c) return;
    known.value = c.contribution / static_cast<float>(samples);
    known.weight = static_cast<float>(weight(eye, light, c, batch.counts));
    known.s = static_cast<std::uint16_t>(light.index + 1);
    known.t = static_cast<std::uint16_t>(eye.index + 1);
    batch.queue.add(shadow_ray(eye, light, c), known);
  }
  /// A contribution with the pixel and index of path `i` of `batch`.
  static Contribution contribution(const EyePaths& batch, std::size_t i) {
    return {.pixel = batch.pixels[i], .path = static_cast<std::uint8_t>(i)};
  }

  /// Traces the queued shadow rays of `batch`, adds the unoccluded contributions to the image and
  /// to the layers, and passes each to `arrived(contribution)`.
  template <class Arrived>
  void flush(const TilePass& pass, EyePaths& batch, Arrived&& arrived) const {
    const IterationContext& context = pass.context;
    batch.queue.flush(
        context.scene.rays(), pass.counters,
        [&](const Contribution& c) {
          accumulate(pass.image.pixels[c.pixel], c.value * c.weight, pass.counters);
          arrived(c);
          if (guide_.learns()) batch.gathered.add(c.path, c.t - 1, c.value * c.weight);
          layers_.strategy(context.layers, c.s, c.t, {c.pixel, c.value, c.weight});
          layers_.distribution(context.layers, c.distribution, c.pixel, c.value * c.weight);
        },
        [&] { context.check_stop(); });
  }
  /// The same while paths of the batch go on, where so many rays wait that they take much memory:
  /// two paths of a thousand edges are joined by a million.
  template <class Arrived>
  void flush_if_long(const TilePass& pass, EyePaths& batch, Arrived&& arrived) const {
    constexpr std::size_t many = 1 << 17;
    if (batch.queue.size() >= many) flush(pass, batch, arrived);
  }
  /// Adds what the paths of the batch have found, and records samples for the guide.
  template <class Arrived>
  void finish(const TilePass& pass, EyePaths& batch, typename Guide::Accumulator& accumulator,
              Arrived&& arrived) const {
    for (std::size_t k = 0; k < batch.states.size(); ++k) {
      accumulate(pass.image.pixels[batch.pixels[k]], batch.radiance[k], pass.counters);
    }
    flush(pass, batch, arrived);
    if (guide_.learns()) batch.gathered.record(guide_, accumulator);
  }
  /// Starts the paths of a Tile::block(), and counts them.
  void start(const TilePass& pass, const Tile& block, EyePaths& batch) const {
    start_paths(pass.context, pass.image, block, batch);
    pass.counters.samples += batch.states.size();
    if (guide_.learns()) batch.gathered.clear();
  }
  /// One accumulator for each tile.
  using Accumulators = std::vector<typename Guide::Accumulator>;
  /// Continues with the branches of the paths; false if there are none left.
  bool resume(Walk<Guide>& walk, EyePaths& batch) const {
    batch.store(walk.branches());
    if (!batch.resume()) return false;
    if (guide_.learns()) batch.gathered.clear();
    return true;
  }
  Accumulators start_accumulators(const Tiling& tiling) const {
    Accumulators accumulators(static_cast<std::size_t>(tiling.tiles()));
    if (guide_.learns()) {
      for (auto& t : accumulators) t = guide_.accumulator();
    }
    return accumulators;
  }
  void update_guide(const IterationContext& context, Accumulators& accumulators) {
    if (guide_.learns()) guide_.update(accumulators, context.pool, 1);
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
            .counts = counts};
  }
  WalkLimits eye_limits(const SampleCounts& counts) const {
    return {.max_depth = settings_.max_depth,
            .roulette_depth = settings_.roulette_depth,
            .packets = true,
            .counts = eye_side(counts)};
  }
  static std::int64_t pixels(const Image& image) {
    return std::int64_t{image.width} * image.height;
  }
  BdptSettings settings_;
  StrategyLayers layers_;
};

/// What paired connections are combined with.
struct Merging {
  bool merge = false;   ///< eye vertices with the vertices of all light paths (mis.h)
  bool connect = true;  ///< all strategies but s = 0
  RadiusSettings radius = {};
};

/// connections: paired. The eye path of pixel j is connected to light path j; for s = 1 a new point
/// on an emitter is sampled at each vertex. With merging: vertex connection and merging (Georgiev
/// et al. 2012). Then all light paths are walked before the eye paths, for their photons; the
/// vertices that are connected are made anew from these, which takes less memory than to keep them
/// whole.
template <class Guide>
class PairedBdpt final : public Bdpt<Guide> {
  using Base = Bdpt<Guide>;
  using Base::guide_;
  using Base::layers_;
  using Base::settings_;
  using typename Base::EyePaths;

 public:
  PairedBdpt(const BdptSettings& settings, Guide guide, const Merging& merging = {})
      : Base(settings, std::move(guide)), merging_(merging) {}

  SceneNeeds needs() const override {
    SceneNeeds needs = Base::needs();
    needs.light_tree = emitters() != EmitterChoice::power;
    return needs;
  }

  std::vector<std::string> layers(std::span<const ImageLayer> wanted) override {
    return layers_.choose(wanted, settings_.max_depth, {}, merging_.merge);
  }

  std::vector<std::pair<std::string, double>> statistics() const override {
    auto stats = Base::statistics();
    if (!merging_.merge) return stats;
    stats.emplace_back("photons", static_cast<double>(photons_.size()));
    stats.emplace_back("radius", photons_.radius());
    seconds_.append_to(stats);
    return stats;
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    const auto pixels = static_cast<double>(Base::pixels(image));
    const bool lit = !context.scene.emitters().empty();
    SampleCounts counts;
    if (lit && merging_.connect) counts = {1, 1, 1, pixels};
    Counters sum;
    if (lit && merging_.merge) {
      const double radius = merge_radius(merging_.radius, context);
      counts.merge = pixels * std::numbers::pi * radius * radius;
      sum = photon_pass(context, counts, radius, image);
    }
    PassSeconds pass;
    sum += eye_pass(context, counts, image);
    pass.end(seconds_.eye);
    return sum;
  }

 private:
  /// How s = 1 selects emitters. Photons have no room for EmitterPoint::next_event_ratio.
  EmitterChoice emitters() const {
    const auto* paired = std::get_if<PairedSettings>(&settings_.connections);
    return merging_.merge || paired == nullptr ? EmitterChoice::power : paired->emitters;
  }
  LightPathSetting light_setting(const IterationContext& context,
                                 const SampleCounts& counts) const {
    LightPathSetting setting = Base::light_setting(context, counts);
    setting.next_event = emitters();
    return setting;
  }

  /// An eye vertex whose photons are looked up.
  struct LookUp {
    std::uint32_t path;
    int depth;
  };
  struct Pairs {
    EyePaths eye;
    LightBatch<Guide> light;
    std::vector<Rng> rngs = {};
    EmittersAhead ahead = {};  // emitters of s = 1
    std::vector<LookUp> look_ups = {};
    double look_up_seconds = 0;
    SparseStop stop = {};
  };

  Counters photon_pass(const IterationContext& context, const SampleCounts& counts, double radius,
                       Image& image) {
    PassSeconds pass;
    photons_.begin(Base::pixels(image));
    const LightPathSetting setting = light_setting(context, counts);
    const Counters sum = light_pass(
        {context, setting, Base::pixels(image), image}, guide_,
        [&](std::size_t path, const LightBatch<Guide>& batch, std::size_t i) {
          photons_.keep_path(path, batch, i);
        },
        Base::splat_layers(context));
    pass.end(seconds_.light);
    photons_.arrange(radius, context.pool);
    pass.end(seconds_.grid);
    return sum;
  }

  Counters eye_pass(const IterationContext& context, const SampleCounts& counts, Image& image) {
    const LightPathSetting setting = light_setting(context, counts);
    const Tiling tiling(image);
    typename Base::Accumulators accumulators = Base::start_accumulators(tiling);
    std::vector<double> seconds(static_cast<std::size_t>(tiling.tiles()), 0.0);
    const auto work = [&](int i, Counters& counters, Splats& splats) {
      Pairs pairs{EyePaths(settings_.max_depth, counts), LightBatch<Guide>(setting, guide_)};
      const typename Base::TilePass pass{context, image, counters};
      Walk<Guide> walk(context.scene, guide_, Base::eye_limits(counts), counters);
      const Tile tile = tiling.tile(i);
      for (int b = 0; b < tile.blocks(); ++b) {
        Base::start(pass, tile.block(b), pairs.eye);
        if (merging_.connect) walk_light(context, pairs, counters, splats);
        do {
          walk_eye(pass, walk, pairs);
          look_up(context, pairs);
          Base::finish(pass, pairs.eye, accumulators[static_cast<std::size_t>(i)],
                       [](const Contribution&) {});
        } while (Base::resume(walk, pairs.eye));
      }
      seconds[static_cast<std::size_t>(i)] = pairs.look_up_seconds;
    };
    const Counters sum =
        for_each_splatting_part(context, tiling.tiles(), image, work, Base::splat_layers(context));
    for (const double s : seconds) seconds_.look_up += s;
    Base::update_guide(context, accumulators);
    return sum;
  }

  /// The light paths that the batch is connected to.
  void walk_light(const IterationContext& context, Pairs& pairs, Counters& counters,
                  Splats& splats) const {
    const std::size_t paths = pairs.eye.states.size();
    pairs.rngs.clear();
    if (pairs.eye.counts.merge > 0) {  // photon_pass() has walked, counted and splatted them
      const auto& pixels = pairs.eye.pixels;
      for (std::size_t k = 0; k < paths; ++k) photons_.restore_path(pixels[k], pairs.light, k);
      return;
    }
    const std::size_t all = std::size_t(context.camera.width()) * context.camera.height();
    for (std::size_t k = 0; k < paths; ++k) {
      const std::size_t pixel = pairs.eye.pixels[k];
      pairs.rngs.push_back(context.shared_path_numbers(pixel, all, Rng::Purpose::light_path));
    }
    pairs.light.walk(pairs.rngs, counters);
    pairs.light.splat(paths, counters, splats);
  }

  void walk_eye(const typename Base::TilePass& pass, Walk<Guide>& walk, Pairs& pairs) const {
    const IterationContext& context = pass.context;
    const NextEvent next_event(context.scene, emitters());
    const SampleCounts& counts = pairs.eye.counts;
    const auto choose = [&](std::size_t i, int depth) {
      if (counts.nee > 0 && depth < settings_.max_depth) {
        pairs.ahead[i] = next_event.choose_ahead(pairs.eye.states[i].rng);
      }
    };
    const auto visit = [&](std::size_t i, int depth) {
      pairs.stop.check(context);
      Base::gather_hit(context, pairs.eye, i, depth, next_event);
      const Vertex& v = pairs.eye.vertex(i, depth);
      const int longest = Base::longest_light_path(v, depth);
      if (longest == 0) return;
      if (counts.merge > 0) pairs.look_ups.push_back({static_cast<std::uint32_t>(i), depth});
      if (counts.nee == 0) return;
      const SurfaceEndpoint<Guide> eye{v, depth, Transport::radiance, guide_};
      const EmitterPoint e = next_event.sample(v, pairs.ahead[i], pairs.eye.states[i].rng);
      const Contribution known = Base::contribution(pairs.eye, i);
      Base::join(eye, EmitterEndpoint<Guide>{e, guide_}, 1, known, pairs.eye);
      const std::size_t path = pairs.eye.origin[i];
      for (int s = 2; s <= std::min(longest, pairs.light.length(path)); ++s) {
        if (!pairs.light.connectible(path, s - 1)) continue;
        Base::join(eye, pairs.light.end(path, s - 1), 1, known, pairs.eye);
      }
      Base::flush_if_long(pass, pairs.eye, [](const Contribution&) {});
    };
    walk.trace_paths(
        pairs.eye.states, choose, visit,
        SelectTogether(next_event, counts.nee > 0, settings_.max_depth, pairs.eye, pairs.ahead));
  }

  /// Merges the eye vertices of the batch with the photons around them.
  void look_up(const IterationContext& context, Pairs& pairs) const {
    if (pairs.look_ups.empty()) return;
    const SampleCounts& counts = pairs.eye.counts;
    const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (const LookUp& at : pairs.look_ups) {
      pairs.stop.check(context);
      const Vertex& v = pairs.eye.vertex(at.path, at.depth);
      const SurfaceEndpoint<Guide> eye{v, at.depth, Transport::radiance, guide_};
      const std::uint32_t pixel = pairs.eye.pixels[at.path];
      Rgb sum(0, 0, 0);
      photons_.for_each_at(
          v, pairs.eye.states[at.path].rng, [&](const Photon& p, float, float count) {
            if (p.index + at.depth > settings_.max_depth) return;
            const Rgb value = merged(eye, p) * static_cast<float>(double(count) / counts.merge);
            if (is_black(value)) return;
            const auto w = static_cast<float>(merge_weight(eye, p, counts));
            sum += value * w;
            layers_.merge(context.layers, p.index + 1, at.depth + 1, {pixel, value, w});
          });
      pairs.eye.radiance[at.path] += sum;
      if (guide_.learns()) pairs.eye.gathered.add(at.path, at.depth, sum);
    }
    pairs.look_ups.clear();
    pairs.look_up_seconds += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
  }

  Merging merging_;
  PhotonMap photons_;
  PhotonSeconds seconds_;
};

/// Connections to light paths that all pixels share, resampled at each eye vertex. The shared paths
/// are the first of those connected to the eye (t = 1).
template <class Guide, SharedConnections Choice>
class ResampledBdpt final : public Bdpt<Guide> {
  using Base = Bdpt<Guide>;
  using Base::guide_;
  using Base::layers_;
  using Base::settings_;
  using typename Base::EyePaths;

 public:
  template <class Settings>
  ResampledBdpt(const BdptSettings& settings, Guide guide, const Settings& connections)
      : Base(settings, std::move(guide)), connections_(connections) {}

  SceneNeeds needs() const override {
    SceneNeeds needs = Base::needs();
    needs.space = needs.space || connections_.needs_space();
    return needs;
  }
  std::vector<std::string> layers(std::span<const ImageLayer> wanted) override {
    return layers_.choose(wanted, settings_.max_depth, Choice::distributions);
  }
  void prepare(const PrepareContext& context) override {
    Base::prepare(context);
    connections_.prepare(context);
    cell_statistics_.resize(connections_.cells());
  }
  std::vector<std::pair<std::string, double>> statistics() const override {
    auto stats = connections_.statistics();
    for (auto& s : Base::statistics()) stats.push_back(std::move(s));
    stats.emplace_back("light_pass_cpu_seconds", seconds_.light);
    stats.emplace_back("distributions_cpu_seconds", seconds_.distributions);
    stats.emplace_back("eye_pass_cpu_seconds", seconds_.eye);
    return stats;
  }
  void save(ByteWriter& out) const override {
    cell_statistics_.save(out);
    connections_.save(out);
    Base::save(out);
  }
  void load(ByteReader& in) override {
    cell_statistics_.load(in);
    connections_.load(in);
    Base::load(in);
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    const bool lit = !context.scene.emitters().empty();
    const auto resampled = static_cast<std::size_t>(connections_.resampling().light_paths);
    const double splatted = connections_.resampling().splat_paths * double(Base::pixels(image));
    const auto paths = std::max(static_cast<std::int64_t>(std::ceil(splatted)),
                                static_cast<std::int64_t>(resampled));
    const double count_as = connections_.resampling().count_as;
    const double count = count_as > 0 ? count_as : static_cast<double>(resampled);
    const SampleCounts counts =
        lit ? SampleCounts{1, count_as > 0 ? 1.0 : count, count, static_cast<double>(paths)}
            : SampleCounts{};

    PassSeconds pass;
    LightVertices lights(lit ? resampled : 0, std::max(1, settings_.max_depth - 1), counts);
    const LightPathSetting setting = Base::light_setting(context, counts);
    Counters counters = light_pass(
        {context, setting, lit ? paths : 0, image}, guide_,
        [&](std::size_t path, const LightBatch<Guide>& batch, std::size_t place) {
          if (path < resampled) lights.keep(path, batch, place);
        },
        Base::splat_layers(context));
    lights.arrange();
    pass.end(seconds_.light);
    connections_.begin(context, lights, cell_statistics_, counters);
    pass.end(seconds_.distributions);
    counters += eye_pass(context, counts, lights, image);
    pass.end(seconds_.eye);
    return counters;
  }

 private:
  Counters eye_pass(const IterationContext& context, const SampleCounts& counts,
                    const LightVertices& lights, Image& image) {
    const Tiling tiling(image);
    std::vector<CellStatistics::Accumulator> accumulators(static_cast<std::size_t>(tiling.tiles()));
    typename Base::Accumulators guide_accumulators = Base::start_accumulators(tiling);
    const Counters sum = for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
      const auto index = static_cast<std::size_t>(i);
      EyePart part{lights, connections_.resampling().roulette * cell_statistics_.mean(index),
                   EyePaths(settings_.max_depth, counts),
                   CellStatistics::Accumulator(cell_statistics_.cells())};
      const auto record = [&](const Contribution& c) { arrived(c, part.accumulator); };
      const typename Base::TilePass pass{context, image, counters};
      Walk<Guide> walk(context.scene, guide_, Base::eye_limits(counts), counters);
      const NextEvent next_event(context.scene, EmitterChoice::power);
      const Tile tile = tiling.tile(i);
      for (int b = 0; b < tile.blocks(); ++b) {
        Base::start(pass, tile.block(b), part.batch);
        do {
          walk.trace_paths(
              part.batch.states, [](std::size_t, int) {},
              [&](std::size_t k, int depth) {
                part.stop.check(context);
                Base::gather_hit(context, part.batch, k, depth, next_event);
                join_lights(part, k, depth);
                Base::flush_if_long(pass, part.batch, record);
              });
          Base::finish(pass, part.batch, guide_accumulators[index], record);
        } while (Base::resume(walk, part.batch));
      }
      part.accumulator.add_paths(static_cast<std::uint64_t>(tile.pixels()));
      part.accumulator.close();
      accumulators[index] = std::move(part.accumulator);
    });
    cell_statistics_.add(accumulators);
    Base::update_guide(context, guide_accumulators);
    return sum;
  }

  /// The state of a tile's eye paths.
  struct EyePart {
    const LightVertices& lights;
    double threshold;  // CellStatistics::survival()
    EyePaths batch;
    CellStatistics::Accumulator accumulator;
    SparseStop stop = {};
  };

  static void arrived(const Contribution& c, CellStatistics::Accumulator& accumulator) {
    const double value = double(luminance(c.value * c.weight));
    if (!std::isfinite(value)) return;
    accumulator.add_path_sum(value);
    if (c.throughput > 0) {
      accumulator.add_contribution(c.cell, c.s, value * double(c.survival) / double(c.throughput),
                                   double(c.survival));
    }
  }

  void join_lights(EyePart& part, std::size_t k, int depth) const {
    const Vertex& v = part.batch.vertex(k, depth);
    const int longest = Base::longest_light_path(v, depth);
    if (longest == 0 || part.lights.paths() == 0) return;
    Rng& rng = part.batch.states[k].rng;
    const SurfaceEndpoint<Guide> eye{v, depth, Transport::radiance, guide_};
    const auto lookup = connections_.find(v, depth, rng);
    part.accumulator.visit(lookup.cell);
    const float throughput = luminance(v.throughput);
    const auto survival = [&](int s) {
      part.accumulator.attempt(lookup.cell, s);
      const float p = cell_statistics_.survival(lookup.cell, s, double(throughput), part.threshold);
      return p >= 1 || rng.decide(p) ? p : 0.0F;
    };
    connections_.sample(lookup, LightRange{part.lights, longest}, rng, survival,
                        [&](int s, const VertexSample& drawn) {
                          const double samples = static_cast<double>(part.lights.paths()) *
                                                 double(drawn.probability) * double(drawn.survival);
                          part.lights.with_end(s, drawn.index, guide_, [&](const auto& light) {
                            Contribution known = Base::contribution(part.batch, k);
                            known.distribution = drawn.distribution;
                            known.survival = drawn.survival;
                            known.throughput = throughput;
                            known.cell = lookup.cell;
                            Base::join(eye, light, samples, known, part.batch);
                          });
                        });
  }

  /// CPU seconds of all threads in the parts of an iteration.
  struct {
    double light = 0, distributions = 0, eye = 0;
  } seconds_;
  Choice connections_;
  CellStatistics cell_statistics_;
};

}  // namespace

std::unique_ptr<Integrator> make_bdpt(const BdptSettings& settings) {
  return with_guides(settings.guide, settings.light_guide, [&]<class Guide>(Guide guide) {
    return ConnectionsRegistry::visit(
        settings.connections,
        [&]<Connections C>(const auto& connections) -> std::unique_ptr<Integrator> {
          if constexpr (std::is_same_v<C, PairedConnections>) {
            return std::make_unique<PairedBdpt<Guide>>(settings, std::move(guide));
          } else {
            return std::make_unique<ResampledBdpt<Guide, C>>(settings, std::move(guide),
                                                             connections);
          }
        });
  });
}

std::unique_ptr<Integrator> make_vcm(const VcmSettings& settings) {
  const BdptSettings bdpt{static_cast<const PathLengths&>(settings)};
  return with_guides(settings.guide, settings.light_guide,
                     [&]<class Guide>(Guide guide) -> std::unique_ptr<Integrator> {
                       return std::make_unique<PairedBdpt<Guide>>(
                           bdpt, std::move(guide),
                           Merging{settings.merge, settings.connect, settings});
                     });
}

}  // namespace lacuna
