#include "renderer/integrators/integrators.h"

#include <algorithm>

#include "renderer/core/passes.h"
#include "renderer/guides/make_guide.h"
#include "renderer/path/direct_light.h"
#include "renderer/path/emitter_selection.h"
#include "renderer/path/path_matches.h"
#include "renderer/path/photon_map.h"
#include "renderer/settings/photon_mapping_settings.h"

namespace lacuna {

namespace {

/// The settings that photon mapping has and its progressive form does not.
struct Density {
  std::size_t nearest = 0;         ///< PhotonMapSettings
  bool final_gather = false;       ///< PhotonMapSettings
  std::int64_t caustic_paths = 0;  ///< PhotonMapSettings
};

/// Photon mapping (Jensen 1996; Noel 2015, 4.5) and its progressive form (Hachisuka and Jensen
/// 2009; Knaus and Zwicker 2011). An eye path is traced through mirrors and glass to the first
/// rough surface. There direct light is sampled, and the density of the photons around the vertex
/// gives all other light. Each iteration has its own photons.
///
/// Each path from an emitter to the eye is counted once, by the light that its first rough vertex x
/// from the eye receives: direct light; caustics, which reach x from an emitter through mirrors and
/// glass only; or other light. With a final gather, other light comes from the photons at the next
/// rough vertex.
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
    Passes passes(context.pool);
    const std::int64_t paths = light_paths(settings_.light_paths, image);
    passes.begin("light paths", seconds_.light);
    Counters sum = light_pass(context, paths, image);
    passes.begin("photon grid", seconds_.grid);
    const double radius = merge_radius(settings_, context);
    for (PhotonMap* map : {&photons_, &caustics_}) {
      if (density_.nearest > 0) {
        map->arrange_nearest(radius, context.pool);
      } else {
        map->arrange(radius, context.pool);
      }
    }
    passes.begin("eye paths", seconds_.eye);
    sum += eye_pass(context, static_cast<double>(paths), image);
    return sum;
  }

 private:
  /// The position of an eye path.
  enum class Stage : std::uint8_t {
    seeing,     ///< it passed mirrors and glass only
    at_first,   ///< at its first rough vertex
    last_edge,  ///< on the edge after it, which may hit an emitter
    gathering,  ///< after it, before the next rough vertex
    at_second,  ///< at that vertex
  };
  /// The kinds of photons that a look-up uses.
  struct Wanted {
    bool direct = false;    ///< on the first vertex of their light path
    bool caustics = false;  ///< that passed mirrors and glass only
    bool others = false;
    bool any() const { return direct || caustics || others; }
    bool of(const Photon& p) const { return of(p.index, p.caustic); }
    /// Whether it uses a photon with this Photon::index and Photon::caustic.
    bool of(int index, bool caustic) const {
      if (index == 1) return direct;
      return caustic ? caustics : others;
    }
  };
  /// The photons of photons_ that the look-up at the first rough vertex uses.
  Wanted at_first() const {
    return {!settings_.next_event_estimation, density_.caustic_paths == 0, !density_.final_gather};
  }
  class TilePass;

  /// Whether photons are looked up at `v`.
  bool is_rough(const Vertex& v) const { return v.bsdf->is_vpl_receiver(least_alpha_); }

  Counters light_pass(const IterationContext& context, std::int64_t paths, Image& image) {
    const std::int64_t all = std::max(paths, density_.caustic_paths);
    photons_.begin(paths);
    caustics_.begin(density_.caustic_paths);
    if (context.scene.emitters().empty()) return {};
    const LightPathSetting setting{
        context.scene,          context.camera, settings_.max_depth,  settings_.roulette_depth,
        SampleCounts{.hit = 0}, true,           EmitterChoice::power, context.light.automaton()};
    // Photons that no look-up uses are not stored: with next event estimation, one of each path.
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

  Counters eye_pass(const IterationContext& context, double paths, Image& image);

  Guide guide_;  ///< of eye paths
  Guide light_guide_;
  PhotonTracing settings_;
  Density density_;
  float least_alpha_;
  PhotonMap photons_, caustics_;
  PhotonSeconds seconds_;
};

/// Renders the eye paths of a tile.
class PhotonMapping::TilePass {
 public:
  /// `paths`: light paths of photons_.
  TilePass(const PhotonMapping& mapping, const IterationContext& context, double paths,
           Image& image, Counters& counters)
      : mapping_(mapping),
        settings_(mapping.settings_),
        context_(context),
        paths_(static_cast<float>(paths)),
        image_(image),
        counters_(counters),
        direct_(context.scene, mapping.guide_, true, EmitterChoice::power),
        batch_(settings_.max_depth),
        selection_(direct_.next_event(), direct_.active(), settings_.max_depth, batch_),
        nearest_(mapping.density_.nearest + 1),
        walk_(context.scene, mapping.guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = settings_.roulette_depth,
               .packets = true,
               .letters = context.light.automaton()},
              counters) {}

  void render(const Tile& tile) {
    for (int b = 0; b < tile.blocks(); ++b) {
      start_paths(context_, image_, tile.block(b), batch_);
      counters_.samples += batch_.states.size();
      stage_.fill(Stage::seeing);
      walk_.trace_paths(
          batch_.states, [this](std::size_t i, int depth) { return visit(i, depth); }, *this);
      shadows_.flush(context_.scene.rays(), counters_,
                     [&](const Direct& d) { contribute(d.path, d.edges, d.matches, d.value); });
      look_up();
      for (std::size_t k = 0; k < batch_.states.size(); ++k) {
        accumulate(image_.pixels[batch_.pixels[k]], batch_.radiance[k], counters_);
      }
    }
  }
  /// CPU seconds of this thread.
  double look_up_seconds() const { return look_up_seconds_; }

  // The selection of Walk::trace_paths(): no emitter is sampled after the first rough vertex.
  void before(std::size_t i, int depth) {
    if (stage_[i] <= Stage::at_first) selection_.before(i, depth);
  }
  bool together() const { return selection_.together(); }
  void choose(std::span<const std::size_t> paths) { selection_.choose(paths); }

 private:
  struct Direct {
    Rgb value;
    std::uint8_t path;
    PathMatches matches;
    int edges;
  };
  struct LookUp {
    std::uint32_t path;
    int depth;
    bool first;  ///< at the first rough vertex
  };
  /// What one photon adds to a look-up, for the layers of light.
  struct PhotonPart {
    V3d value;
    int edges;
    PathMatches matches;
  };

  /// Adds a contribution to the pixel of path `i`. All contributions but those of photons go
  /// through this function.
  void contribute(std::size_t i, int edges, PathMatches matches, const Rgb& value) {
    batch_.radiance[i] += value;
    context_.light.add(batch_.pixels[i], edges, matches, value);
  }

  /// Updates the stage for the edge to the vertex at `depth` and adds the emission there, if it
  /// counts; false if the path ends on that edge.
  bool arrive(std::size_t i, int depth) {
    const Vertex& v = batch_.vertex(i, depth);
    Stage& stage = stage_[i];
    const Vertex& last = batch_.vertex(i, depth - 1);
    const bool passed = last.delta;
    if (stage == Stage::at_first && passed) stage = Stage::seeing;
    if (stage == Stage::at_second && passed) stage = Stage::gathering;
    if (stage == Stage::at_second) return false;
    const bool first_edge = stage == Stage::at_first;
    if (first_edge) stage = mapping_.density_.final_gather ? Stage::gathering : Stage::last_edge;
    const bool hit = first_edge ? settings_.next_event_estimation : stage == Stage::seeing;
    if (hit) {
      contribute(i, depth, matches_at_hit(context_.light.automaton(), v),
                 direct_.hit(v, last, depth));
    }
    return stage != Stage::last_edge;
  }

  /// Visits a vertex of an eye path; false if the path ends.
  bool visit(std::size_t i, int depth) {
    stop_.check(context_);
    const Vertex& v = batch_.vertex(i, depth);
    if (!arrive(i, depth)) return false;
    if (v.kind != Vertex::Kind::surface || depth == settings_.max_depth) return false;
    Stage& stage = stage_[i];
    const bool rough = mapping_.is_rough(v);
    const bool nee = settings_.next_event_estimation;
    if (stage == Stage::gathering) {
      if (!rough) return true;
      look_ups_.push_back({static_cast<std::uint32_t>(i), depth, false});
      stage = Stage::at_second;
      return true;
    }
    if (direct_.active() && v.bsdf->connectible() && (nee || !rough)) {
      direct_.sample(v, depth, selection_.of(i), batch_.states[i].rng,
                     [&](const Ray& ray, const Rgb& value, const DirectLight::Sample& to) {
                       const auto matches =
                           matches_beyond(context_.light.automaton(), endpoint(v, depth), to.w);
                       shadows_.add(ray, {value, static_cast<std::uint8_t>(i), matches, depth + 1});
                     });
    }
    if (!rough) return true;
    look_ups_.push_back({static_cast<std::uint32_t>(i), depth, true});
    stage = Stage::at_first;
    return true;
  }

  void look_up() {
    const bool apart = mapping_.density_.caustic_paths > 0;
    const Wanted first = mapping_.at_first();
    const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (const LookUp& at : look_ups_) {
      stop_.check(context_);
      if (!at.first) {
        add_photons(mapping_.photons_, {true, true, true}, at, paths_);
        continue;
      }
      if (first.any()) add_photons(mapping_.photons_, first, at, paths_);
      if (apart) {
        add_photons(mapping_.caustics_, {false, true, false}, at,
                    static_cast<float>(mapping_.density_.caustic_paths));
      }
    }
    look_ups_.clear();
    look_up_seconds_ += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
  }

  SurfaceEndpoint endpoint(const Vertex& v, int depth) const {
    return {v, depth, Transport::radiance, mapping_.guide_};
  }

  /// Adds the radiance that the photons of `map` around an eye vertex, from `paths` light paths,
  /// estimate.
  void add_photons(const PhotonMap& map, const Wanted& wanted, const LookUp& at, float paths) {
    const Vertex& v = batch_.vertex(at.path, at.depth);
    const SurfaceEndpoint eye = endpoint(v, at.depth);
    V3d sum(0);
    parts_.clear();
    const auto add = [&](const Photon& p, double d2, float count) {
      if (p.index + at.depth > settings_.max_depth || !wanted.of(p)) return;
      const V3d value = V3d(merged(eye, p) * count) * kernel(d2);
      sum += value;
      if (context_.light) {
        parts_.push_back({value, p.index + at.depth,
                          matches_beyond(context_.light.automaton(), eye, p.wp, p.letters)});
      }
    };
    double radius2 = map.radius() * map.radius();
    if (mapping_.density_.nearest > 0) {
      radius2 =
          map.for_each_nearest(v, nearest_, [&](const Photon& p, double d2) { add(p, d2, 1); });
    } else {
      map.for_each_at(v, batch_.states[at.path].rng,
                      [&](const Photon& p, float distance2, float count) {
                        add(p, double(distance2) / radius2, count);
                      });
    }
    // Eye and light have each met a blended surface with probability alpha: once too often.
    const double covered = double(context_.scene.coverage(v.surface));
    const double area = std::numbers::pi * radius2 * covered;
    batch_.radiance[at.path] += Rgb(sum / area) / paths;
    for (const PhotonPart& part : parts_) {
      context_.light.add(batch_.pixels[at.path], part.edges, part.matches,
                         Rgb(part.value / area) / paths);
    }
  }

  /// Kernel of the density estimate at squared distance `d2`, in units of the radius; its mean over
  /// the disc is 1.
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

  const PhotonMapping& mapping_;
  const PhotonTracing& settings_;
  const IterationContext& context_;
  float paths_;
  Image& image_;
  Counters& counters_;
  DirectLight direct_;
  EyeBatch batch_;
  EmitterSelection selection_;
  ShadowQueue<Direct> shadows_;
  std::array<Stage, EyeBatch::size> stage_ = {};
  std::vector<LookUp> look_ups_;
  std::vector<PhotonPart> parts_;          // of one look-up
  std::vector<PointTree::Found> nearest_;  // room for one more than Density::nearest
  double look_up_seconds_ = 0;
  SparseStop stop_;
  Walk walk_;
};

Counters PhotonMapping::eye_pass(const IterationContext& context, double paths, Image& image) {
  const Tiling tiling(image);
  std::vector<double> seconds(static_cast<std::size_t>(tiling.tiles()), 0.0);
  const Counters sum = for_each_part(context, tiling.tiles(), [&](int i, Counters& counters) {
    TilePass pass(*this, context, paths, image, counters);
    pass.render(tiling.tile(i));
    seconds[static_cast<std::size_t>(i)] = pass.look_up_seconds();
  });
  for (const double s : seconds) seconds_.look_up += s;
  return sum;
}

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
