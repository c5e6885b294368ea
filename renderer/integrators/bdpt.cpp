#include "renderer/integrators/merging_bdpt.h"

#include "renderer/connections/registry.h"
#include "renderer/core/passes.h"
#include "renderer/guides/make_guide.h"
#include "renderer/integrators/integrators.h"
#include "renderer/path/emitter_selection.h"
#include "renderer/path/light_pass.h"
#include "renderer/settings/connections_settings.h"
#include "renderer/settings/vcm_settings.h"

namespace lacuna {

namespace {

/// connections: paired. The eye path of pixel j is connected to light path j; for s = 1 a new point
/// on an emitter is sampled at each vertex, or that of the light path is taken (DirectPoint). With
/// merging all light paths are traced before the eye paths, for their photons. The vertices for
/// connections are restored from the photons, which takes less memory than storing whole vertices.
class PairedBdpt final : public MergingBdpt {
  using Base = MergingBdpt;
  using Base::EyePaths;
  using Base::guide_;
  using Base::layers_;
  using Base::LookUps;
  using Base::merging_;
  using Base::photons_;
  using Base::settings_;

 public:
  PairedBdpt(const BdptSettings& settings, Guide guide, const Merging& merging)
      : Base(settings, std::move(guide), merging) {}

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
    if (merging_.merge) seconds_.append_to(stats);
    return stats;
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    const auto pixels = static_cast<double>(Base::pixels(image));
    const bool lit = !context.scene.emitters().empty();
    SampleCounts counts;
    if (lit && merging_.connect) counts = {1, 1, 1, pixels};
    Counters sum = guide_.begin(context, settings_.max_depth);
    if (lit) counts.merge = Base::begin_merging(context, Base::pixels(image));
    if (counts.merge > 0) sum += photon_pass(context, counts, image);
    Passes passes(context.pool);
    passes.begin("eye paths", seconds_.eye);
    sum += eye_pass(context, counts, image);
    return sum;
  }

 private:
  /// How next event estimation (s = 1) selects emitters. With merging by power, because a Photon
  /// does not store Vertex::next_event_ratio.
  EmitterChoice emitters() const {
    return merging_.merge || takes_light_path() ? EmitterChoice::power : paired().emitters;
  }
  const PairedSettings& paired() const { return std::get<PairedSettings>(settings_.connections); }
  /// A photon does not store the point on the emitter.
  bool takes_light_path() const {
    return !merging_.merge && paired().direct == DirectPoint::light_path;
  }
  bool one_ray() const { return paired().rays == ConnectionRays::one; }
  LightPathSetting light_setting(const IterationContext& context,
                                 const SampleCounts& counts) const {
    LightPathSetting setting = Base::light_setting(context, counts);
    setting.next_event = emitters();
    return setting;
  }

  struct Pairs {
    EyePaths eye;
    LightBatch light;
    LookUps look_ups = {};
    std::vector<Rng> rngs = {};
    SparseStop stop = {};
  };

  Counters photon_pass(const IterationContext& context, const SampleCounts& counts, Image& image) {
    Passes passes(context.pool);
    passes.begin("light paths", seconds_.light);
    const LightPathSetting setting = light_setting(context, counts);
    const Counters sum = light_pass(
        {context, setting, Base::pixels(image), image}, guide_,
        [&](std::size_t path, const LightBatch& batch, std::size_t i) {
          photons_.keep_path(path, batch, i);
        },
        Base::splat_layers(context));
    passes.begin("photon grid", seconds_.grid);
    Base::arrange_photons(context);
    return sum;
  }

  Counters eye_pass(const IterationContext& context, const SampleCounts& counts, Image& image) {
    const LightPathSetting setting = light_setting(context, counts);
    const Tiling tiling(image);
    std::vector<TrainingSamples::Part> samples(static_cast<std::size_t>(tiling.tiles()));
    std::vector<double> seconds(static_cast<std::size_t>(tiling.tiles()), 0.0);
    const auto work = [&](int i, Counters& counters, Splats& splats) {
      Pairs pairs{EyePaths(settings_.max_depth, counts, context), LightBatch(setting, guide_)};
      const Base::TilePass pass{context, image, counters};
      Walk walk(context.scene, guide_, Base::eye_limits(context, counts), counters);
      const Tile tile = tiling.tile(i);
      for (int b = 0; b < tile.blocks(); ++b) {
        Base::start(pass, tile.block(b), pairs.eye);
        if (one_ray()) {
          pairs.eye.one_ray.emplace().start(
              {context.seed, context.iteration, pairs.eye.pixels[0], Rng::Purpose::one_ray},
              EyeBatch::size);
        }
        if (merging_.connect) walk_light(context, pairs, counters, splats);
        do {
          walk_eye(pass, walk, pairs);
          Base::look_up(pass, pairs.eye, pairs.look_ups);
          Base::finish(pass, pairs.eye, samples[static_cast<std::size_t>(i)],
                       [](const BdptContribution&) {});
        } while (Base::resume(walk, pairs.eye));
      }
      seconds[static_cast<std::size_t>(i)] = pairs.look_ups.seconds;
    };
    const Counters sum =
        for_each_splatting_part(context, tiling.tiles(), image, work, Base::splat_layers(context));
    for (const double s : seconds) seconds_.look_up += s;
    Base::update_guide(context, samples);
    return sum;
  }

  /// Traces, or restores, the light paths that the eye paths of the batch are connected to.
  void walk_light(const IterationContext& context, Pairs& pairs, Counters& counters,
                  Splats& splats) const {
    const std::size_t paths = pairs.eye.states.size();
    pairs.rngs.clear();
    if (pairs.eye.counts.merge > 0) {  // photon_pass() has traced, counted and splatted them
      const auto& pixels = pairs.eye.pixels;
      pairs.light.clear();
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

  void walk_eye(const Base::TilePass& pass, Walk& walk, Pairs& pairs) const {
    const NextEvent next_event(pass.context.scene, emitters());
    EmitterSelection selection(next_event, pairs.eye.counts.nee > 0 && !takes_light_path(),
                               settings_.max_depth, pairs.eye);
    walk.trace_paths(
        pairs.eye.states,
        [&](std::size_t i, int depth) {
          pairs.stop.check(pass.context);
          Base::add_hit(pass, pairs.eye, i, depth, next_event);
          connect_vertex(next_event, selection, pairs, i, depth);
          Base::flush_if_long(pass, pairs.eye, [](const BdptContribution&) {});
        },
        selection);
  }

  /// Connects vertex `depth` of eye path `i` to a point on an emitter and to its light path,
  /// and marks it for look_up().
  void connect_vertex(const NextEvent& next_event, const EmitterSelection& selection, Pairs& pairs,
                      std::size_t i, int depth) const {
    const SampleCounts& counts = pairs.eye.counts;
    const Vertex& v = pairs.eye.vertex(i, depth);
    const int longest = Base::longest_light_path(v, depth);
    if (longest == 0) return;
    if (counts.merge > 0) pairs.look_ups.add(i, depth);
    if (counts.nee == 0) return;
    const SurfaceEndpoint eye{v, depth, Transport::radiance, guide_};
    const std::size_t path = pairs.eye.origin[i];
    const EmitterPoint e = takes_light_path()
                               ? pairs.light.emitter(path)
                               : next_event.sample(v, selection.of(i), pairs.eye.states[i].rng);
    const BdptContribution known{.path = static_cast<std::uint8_t>(i)};
    Base::queue_connection(eye, EmitterEndpoint{e, guide_}, 1, known, pairs.eye);
    pairs.light.for_each_vertex(path, [&](std::size_t j, int index) {
      if (index >= longest || !pairs.light.connectible(j, index)) return;
      Base::queue_connection(eye, pairs.light.end(j, index), 1, known, pairs.eye,
                             [&] { return pairs.light.path_to(j, index); });
    });
  }

  PhotonSeconds seconds_;
};

/// Connections to vertices of light paths that all pixels share, resampled at each eye vertex. The
/// shared paths are the first of those whose vertices are connected to the eye (t = 1).
template <SharedConnections Choice>
class ResampledBdpt final : public MergingBdpt {
  using Base = MergingBdpt;
  using Base::EyePaths;
  using Base::guide_;
  using Base::layers_;
  using Base::LookUps;
  using Base::merging_;
  using Base::photons_;
  using Base::settings_;

 public:
  template <class Settings>
  ResampledBdpt(const BdptSettings& settings, Guide guide, const Merging& merging,
                const Settings& connections)
      : Base(settings, std::move(guide), merging), connections_(connections) {}

  SceneNeeds needs() const override {
    SceneNeeds needs = Base::needs();
    needs.space = needs.space || connections_.needs_space();
    return needs;
  }
  std::vector<std::string> layers(std::span<const ImageLayer> wanted) override {
    return layers_.choose(wanted, settings_.max_depth, Choice::distributions, merging_.merge);
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
    SampleCounts counts;
    if (lit) {
      counts = {1, count_as > 0 ? 1.0 : count, count, static_cast<double>(paths),
                Base::begin_merging(context, paths)};
    }

    Passes passes(context.pool);
    passes.begin("light paths", seconds_.light);
    LightVertices lights(lit ? resampled : 0, std::max(1, settings_.max_depth - 1), counts);
    const LightPathSetting setting = Base::light_setting(context, counts);
    Counters counters = guide_.begin(context, settings_.max_depth);
    counters += light_pass(
        {context, setting, lit ? paths : 0, image}, guide_,
        [&](std::size_t path, const LightBatch& batch, std::size_t place) {
          if (path < resampled) lights.keep(path, batch, place);
          if (counts.merge == 0) return;
          batch.for_each_vertex(place, [&](std::size_t j, int index) {
            photons_.keep(path, batch.vertex(j, index), index);
          });
        },
        Base::splat_layers(context));
    lights.arrange();
    if (counts.merge > 0) Base::arrange_photons(context);
    passes.begin("distributions", seconds_.distributions);
    connections_.begin(context, lights, cell_statistics_, counters);
    passes.begin("eye paths", seconds_.eye);
    counters += eye_pass(context, counts, lights, image);
    return counters;
  }

 private:
  Counters eye_pass(const IterationContext& context, const SampleCounts& counts,
                    const LightVertices& lights, Image& image) {
    const Tiling tiling(image);
    std::vector<CellStatistics::Accumulator> accumulators(static_cast<std::size_t>(tiling.tiles()));
    std::vector<TrainingSamples::Part> samples(static_cast<std::size_t>(tiling.tiles()));
    const Counters sum = for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
      const auto index = static_cast<std::size_t>(i);
      EyePart part{lights, connections_.resampling().roulette * cell_statistics_.mean(index),
                   EyePaths(settings_.max_depth, counts, context),
                   CellStatistics::Accumulator(cell_statistics_.cells())};
      const auto record = [&](const BdptContribution& c) { arrived(c, part.accumulator); };
      const Base::TilePass pass{context, image, counters};
      Walk walk(context.scene, guide_, Base::eye_limits(context, counts), counters);
      const NextEvent next_event(context.scene, EmitterChoice::power);
      const Tile tile = tiling.tile(i);
      for (int b = 0; b < tile.blocks(); ++b) {
        Base::start(pass, tile.block(b), part.batch);
        do {
          walk.trace_paths(part.batch.states, [&](std::size_t k, int depth) {
            part.stop.check(context);
            Base::add_hit(pass, part.batch, k, depth, next_event);
            connect_vertex(part, k, depth);
            Base::flush_if_long(pass, part.batch, record);
          });
          Base::look_up(pass, part.batch, part.look_ups);
          Base::finish(pass, part.batch, samples[index], record);
        } while (Base::resume(walk, part.batch));
      }
      part.accumulator.add_paths(static_cast<std::uint64_t>(tile.pixels()));
      part.accumulator.close();
      accumulators[index] = std::move(part.accumulator);
    });
    cell_statistics_.add(accumulators);
    Base::update_guide(context, samples);
    return sum;
  }

  /// The state of a tile's eye paths.
  struct EyePart {
    const LightVertices& lights;
    double threshold;  // CellStatistics::survival()
    EyePaths batch;
    CellStatistics::Accumulator accumulator;
    LookUps look_ups = {};
    SparseStop stop = {};
  };

  static void arrived(const BdptContribution& c, CellStatistics::Accumulator& accumulator) {
    const double value = double(luminance(c.value * c.weight));
    if (!std::isfinite(value)) return;
    accumulator.add_path_sum(value);
    if (c.throughput > 0) {
      accumulator.add_contribution(c.cell, c.s, value * double(c.survival) / double(c.throughput),
                                   double(c.survival));
    }
  }

  void connect_vertex(EyePart& part, std::size_t k, int depth) const {
    const Vertex& v = part.batch.vertex(k, depth);
    const int longest = Base::longest_light_path(v, depth);
    if (longest == 0 || part.lights.paths() == 0) return;
    if (part.batch.counts.merge > 0) part.look_ups.add(k, depth);
    Rng& rng = part.batch.states[k].rng;
    const SurfaceEndpoint eye{v, depth, Transport::radiance, guide_};
    const auto lookup = connections_.find(v, depth, rng);
    part.accumulator.visit(lookup.cell);
    const float throughput = luminance(v.throughput);
    const auto survival = [&](int s) {
      part.accumulator.attempt(lookup.cell, s);
      const float p = cell_statistics_.survival(lookup.cell, s, double(throughput), part.threshold);
      return p >= 1 || rng.decide(p) ? p : 0.0F;
    };
    const auto connect_to = [&](int s, const VertexSample& sample) {
      const double samples =
          double(part.lights.paths()) * double(sample.probability) * double(sample.survival);
      part.lights.with_end(s, sample.index, guide_, [&](const auto& light) {
        const BdptContribution known{.path = static_cast<std::uint8_t>(k),
                                     .distribution = sample.distribution,
                                     .survival = sample.survival,
                                     .throughput = throughput,
                                     .cell = lookup.cell};
        Base::queue_connection(eye, light, samples, known, part.batch);
      });
    };
    connections_.sample(lookup, LightRange{part.lights, longest}, rng, survival, connect_to);
  }

  /// CPU seconds of all threads in the parts of an iteration.
  struct {
    double light = 0, distributions = 0, eye = 0;
  } seconds_;
  Choice connections_;
  CellStatistics cell_statistics_;
};

}  // namespace

namespace {

std::unique_ptr<Integrator> make(const BdptSettings& settings, const Merging& merging) {
  return ConnectionsRegistry::visit(
      settings.connections,
      [&]<Connections C>(const auto& connections) -> std::unique_ptr<Integrator> {
        Guide guide = make_guide(settings.guide, settings.light_guide);
        if constexpr (std::is_same_v<C, PairedConnections>) {
          return std::make_unique<PairedBdpt>(settings, std::move(guide), merging);
        } else {
          return std::make_unique<ResampledBdpt<C>>(settings, std::move(guide), merging,
                                                    connections);
        }
      });
}

}  // namespace

std::unique_ptr<Integrator> make_bdpt(const BdptSettings& settings) { return make(settings, {}); }

std::unique_ptr<Integrator> make_vcm(const VcmSettings& settings) {
  BdptSettings bdpt{static_cast<const PathLengths&>(settings)};
  bdpt.connections = settings.connections;
  bdpt.guide = settings.guide;
  bdpt.light_guide = settings.light_guide;
  return make(bdpt, {settings.merge, settings.connect, settings});
}

}  // namespace lacuna
