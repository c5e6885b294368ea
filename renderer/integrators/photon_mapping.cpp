#include "renderer/integrators/integrators.h"

#include <algorithm>

#include "renderer/core/pass_seconds.h"
#include "renderer/guides/make_guide.h"
#include "renderer/path/direct_light.h"
#include "renderer/path/next_event_batch.h"
#include "renderer/path/photon_map.h"
#include "renderer/settings/photon_mapping_settings.h"

namespace lacuna {

namespace {

/// What photon mapping and its progressive form differ in.
struct Density {
  std::size_t nearest = 0;         ///< PhotonMapSettings
  bool final_gather = false;       ///< PhotonMapSettings
  std::int64_t caustic_paths = 0;  ///< PhotonMapSettings
};

/// Photon mapping (Jensen 1996; Noel 2015, 4.5) and its progressive form (Hachisuka and Jensen
/// 2009; Knaus and Zwicker 2011). An eye path is followed through mirrors and glass to the first
/// rough surface, where direct light is sampled and the density of the photons around it gives the
/// rest. Each iteration has its own photons.
///
/// Every path of light is counted once, by what its first rough vertex x from the eye receives:
/// direct light; caustics, which reach x from an emitter by way of mirrors and glass only; the
/// rest. With a final gather the rest comes from the photons at the next rough vertex.
class PhotonMapping final : public Integrator {
 public:
  PhotonMapping(const PhotonTracing& settings, const Density& density, Guide light_guide)
      : light_guide_(std::move(light_guide)),
        settings_(settings),
        density_(density),
        least_alpha_(static_cast<float>(settings.least_roughness * settings.least_roughness)) {}

  SceneNeeds needs() const override {
    return {.materials = true, .emission = true, .space = light_guide_.needs_space()};
  }
  void prepare(const PrepareContext& context) override { light_guide_.prepare(context); }

  std::vector<std::pair<std::string, double>> statistics() const override {
    auto stats = light_guide_.statistics();
    stats.emplace_back("photons", static_cast<double>(photons_.size() + caustics_.size()));
    stats.emplace_back("radius", photons_.radius());
    seconds_.append_to(stats);
    return stats;
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    PassSeconds pass;
    const std::int64_t paths = light_paths(settings_.light_paths, image);
    Counters sum = light_pass(context, paths, image);
    pass.end(seconds_.light);
    const double radius = merge_radius(settings_, context);
    for (PhotonMap* map : {&photons_, &caustics_}) {
      if (density_.nearest > 0) {
        map->arrange_nearest(radius, context.pool);
      } else {
        map->arrange(radius, context.pool);
      }
    }
    pass.end(seconds_.grid);
    sum += eye_pass(context, static_cast<double>(paths), image);
    pass.end(seconds_.eye);
    return sum;
  }

 private:
  /// Where an eye path is.
  enum class Stage : std::uint8_t {
    seeing,     ///< behind mirrors and glass only
    at_first,   ///< at its first rough vertex
    last_edge,  ///< on the edge behind it, which may hit an emitter
    gathering,  ///< behind it, until the next rough vertex
    at_second,  ///< there
  };
  /// The photons that count in a look-up.
  struct Wanted {
    bool direct = false;    ///< of direct light
    bool caustics = false;  ///< by mirrors and glass only
    bool others = false;
    bool any() const { return direct || caustics || others; }
    bool of(const Photon& p) const { return of(p.index, p.caustic); }
    /// `index`, `caustic`: of the photon.
    bool of(int index, bool caustic) const {
      if (index == 1) return direct;
      return caustic ? caustics : others;
    }
  };
  /// At the first rough vertex, of photons_.
  Wanted at_first() const {
    return {!settings_.next_event_estimation, density_.caustic_paths == 0, !density_.final_gather};
  }
  struct LookUp {
    std::uint32_t path;
    int depth;
    bool first;  ///< at the first rough vertex
  };
  struct Direct {
    Rgb value;
    std::size_t path;
  };
  struct Part {
    EyeBatch batch;
    std::vector<PointTree::Found> nearest;  // and the next one
    std::array<Stage, EyeBatch::size> stage = {};
    EmittersAhead ahead = {};  // emitters of next event estimation
    ShadowQueue<Direct> shadows = {};
    std::vector<LookUp> look_ups = {};
    double look_up_seconds = 0;
    SparseStop stop = {};
  };

  /// Whether photons are looked up here.
  bool is_rough(const Vertex& v) const { return v.bsdf->is_vpl_receiver(least_alpha_); }

  Counters light_pass(const IterationContext& context, std::int64_t paths, Image& image) {
    const std::int64_t all = std::max(paths, density_.caustic_paths);
    photons_.begin(paths);
    caustics_.begin(density_.caustic_paths);
    if (context.scene.emitters().empty()) return {};
    const LightPathSetting setting{context.scene,          context.camera,
                                   settings_.max_depth,    settings_.roulette_depth,
                                   SampleCounts{.hit = 0}, true};
    // What is never looked up is not stored: with next event estimation, a photon of each path.
    const Wanted kept = density_.final_gather ? Wanted{true, true, true} : at_first();
    return lacuna::light_pass(
        {context, setting, all, image}, light_guide_,
        [&](std::size_t path, const LightBatch& batch, std::size_t i) {
          const auto number = static_cast<std::int64_t>(path);
          batch.for_each_branch(i, [&](std::size_t j) {
            bool caustic = true;  // so far
            for (int s = 1; s < batch.length(j); ++s) {
              const Vertex& v = batch.vertex(j, s);
              if (!is_rough(v)) continue;
              const bool focused = caustic && s > 1;
              caustic = caustic && v.delta;
              if (s < batch.first(j)) continue;
              if (number < paths && kept.of(s, focused)) photons_.keep(path, v, s, focused);
              if (focused && number < density_.caustic_paths) caustics_.keep(path, v, s, true);
            }
          });
        },
        [](const Splat&) {});
  }

  Counters eye_pass(const IterationContext& context, double paths, Image& image) {
    const Tiling tiling(image);
    std::vector<double> seconds(static_cast<std::size_t>(tiling.tiles()), 0.0);
    const Counters sum = for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
      Part part{EyeBatch(settings_.max_depth), std::vector<PointTree::Found>(density_.nearest + 1)};
      const Tile tile = tiling.tile(i);
      for (int b = 0; b < tile.blocks(); ++b) {
        start_paths(context, image, tile.block(b), part.batch);
        counters.samples += part.batch.states.size();
        part.stage.fill(Stage::seeing);
        trace(context, part, counters);
        look_up(context, paths, part);
        for (std::size_t k = 0; k < part.batch.states.size(); ++k) {
          accumulate(image.pixels[part.batch.pixels[k]], part.batch.radiance[k], counters);
        }
      }
      seconds[static_cast<std::size_t>(i)] = part.look_up_seconds;
    });
    for (const double s : seconds) seconds_.look_up += s;
    return sum;
  }

  void trace(const IterationContext& context, Part& part, Counters& counters) const {
    const DirectLight direct(context.scene, guide_, true, EmitterChoice::power);
    Walk walk(context.scene, guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = settings_.roulette_depth,
               .packets = true},
              counters);
    const auto choose = [&](std::size_t i, int depth) {
      if (direct.draws() && depth < settings_.max_depth && part.stage[i] <= Stage::at_first) {
        part.ahead[i] = direct.choose_ahead(part.batch.states[i].rng);
      }
    };
    walk.trace_paths(part.batch.states, choose, [&](std::size_t i, int depth) {
      part.stop.check(context);
      return visit(direct, part, i, depth);
    });
    part.shadows.flush(context.scene.rays(), counters,
                       [&](const Direct& d) { part.batch.radiance[d.path] += d.value; });
  }

  /// Takes the edge to the vertex at `depth` into account; false where the path ends before it.
  bool arrive(const DirectLight& direct, Part& part, std::size_t i, int depth) const {
    const Vertex& v = part.batch.vertex(i, depth);
    Stage& stage = part.stage[i];
    const Vertex& before = part.batch.vertex(i, depth - 1);
    const bool passed = before.delta;
    if (stage == Stage::at_first && passed) stage = Stage::seeing;
    if (stage == Stage::at_second && passed) stage = Stage::gathering;
    if (stage == Stage::at_second) return false;
    const bool first_edge = stage == Stage::at_first;
    if (first_edge) stage = density_.final_gather ? Stage::gathering : Stage::last_edge;
    const bool hit = first_edge ? settings_.next_event_estimation : stage == Stage::seeing;
    if (hit) part.batch.radiance[i] += direct.met(v, before, depth);
    return stage != Stage::last_edge;
  }

  /// One vertex of an eye path; false where the path ends.
  bool visit(const DirectLight& direct, Part& part, std::size_t i, int depth) const {
    const Vertex& v = part.batch.vertex(i, depth);
    if (!arrive(direct, part, i, depth)) return false;
    if (v.kind != Vertex::Kind::surface || depth == settings_.max_depth) return false;
    Stage& stage = part.stage[i];
    const bool rough = is_rough(v);
    const bool nee = settings_.next_event_estimation;
    if (stage == Stage::gathering) {
      if (!rough) return true;
      part.look_ups.push_back({static_cast<std::uint32_t>(i), depth, false});
      stage = Stage::at_second;
      return true;
    }
    if (direct.draws() && v.bsdf->connectible() && (nee || !rough)) {
      direct.draw(v, depth, part.ahead[i], part.batch.states[i].rng,
                  [&](const Ray& ray, const Rgb& value, const V3f&) {
                    part.shadows.add(ray, {value, i});
                  });
    }
    if (!rough) return true;
    part.look_ups.push_back({static_cast<std::uint32_t>(i), depth, true});
    stage = Stage::at_first;
    return true;
  }

  void look_up(const IterationContext& context, double paths, Part& part) const {
    const bool apart = density_.caustic_paths > 0;
    const Wanted first = at_first();
    const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (const LookUp& at : part.look_ups) {
      part.stop.check(context);
      Rgb& radiance = part.batch.radiance[at.path];
      if (!at.first) {
        radiance += estimate(photons_, {true, true, true}, at, part) / static_cast<float>(paths);
        continue;
      }
      if (first.any()) {
        radiance += estimate(photons_, first, at, part) / static_cast<float>(paths);
      }
      if (apart) {
        radiance += estimate(caustics_, {false, true, false}, at, part) /
                    static_cast<float>(density_.caustic_paths);
      }
    }
    part.look_ups.clear();
    part.look_up_seconds += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
  }

  /// The radiance that the photons of `map` around an eye vertex give, times the number of their
  /// light paths.
  Rgb estimate(const PhotonMap& map, const Wanted& wanted, const LookUp& at, Part& part) const {
    const Vertex& v = part.batch.vertex(at.path, at.depth);
    const SurfaceEndpoint eye{v, at.depth, Transport::radiance, guide_};
    V3d sum(0);
    const auto add = [&](const Photon& p, double d2, float count) {
      if (p.index + at.depth > settings_.max_depth || !wanted.of(p)) return;
      sum += V3d(merged(eye, p) * count) * kernel(d2);
    };
    double radius2 = map.radius() * map.radius();
    if (density_.nearest > 0) {
      radius2 =
          map.for_each_nearest(v, part.nearest, [&](const Photon& p, double d2) { add(p, d2, 1); });
    } else {
      map.for_each_at(v, part.batch.states[at.path].rng,
                      [&](const Photon& p, float distance2, float count) {
                        add(p, double(distance2) / radius2, count);
                      });
    }
    return Rgb(sum / (std::numbers::pi * radius2));
  }

  /// At squared distance `d2` in units of the radius; its mean over the disc is 1.
  double kernel(double d2) const {
    switch (settings_.kernel) {
      case PhotonKernel::cone:
        return 3 * (1 - std::sqrt(d2));
      case PhotonKernel::epanechnikov:
        return 2 * (1 - d2);
      case PhotonKernel::constant:
        break;
    }
    return 1;
  }

  Guide guide_;  ///< of eye paths
  Guide light_guide_;
  PhotonTracing settings_;
  Density density_;
  float least_alpha_;
  PhotonMap photons_, caustics_;
  PhotonSeconds seconds_;
};

std::unique_ptr<Integrator> make(const PhotonTracing& settings, const Density& density) {
  return std::make_unique<PhotonMapping>(settings, density, make_light_guide(settings.light_guide));
}

}  // namespace

std::unique_ptr<Integrator> make_sppm(const SppmSettings& settings) {
  return make(settings, Density{});
}

std::unique_ptr<Integrator> make_photon_map(const PhotonMapSettings& settings) {
  return make(settings, Density{static_cast<std::size_t>(settings.nearest), settings.final_gather,
                                settings.caustic_paths});
}

}  // namespace lacuna
