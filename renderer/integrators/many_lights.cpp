#include "renderer/integrators/integrators.h"

#include "base/parallel/spares.h"
#include "renderer/core/pass_seconds.h"
#include "renderer/many_lights/light_filter.h"
#include "renderer/many_lights/light_gather.h"
#include "renderer/path/direct_light.h"
#include "renderer/path/light_pass.h"
#include "renderer/path/next_event_batch.h"
#include "renderer/settings/gather_settings.h"
#include "renderer/settings/many_lights_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/registry.h"

namespace lacuna {

namespace {

/// Many-light rendering (Noel 2015, 4.4): the first connectible vertex of every eye path gathers
/// all virtual lights. Path tracing continues from there for the light that they lack.
template <Visibility V>
class ManyLights final : public Integrator {
 public:
  template <class Settings>
  ManyLights(const ManyLightsSettings& settings, const Settings& visibility)
      : settings_(settings),
        least_alpha_(static_cast<float>(settings.least_roughness * settings.least_roughness)),
        visibility_(visibility) {}

  SceneNeeds needs() const override {
    return {.materials = true, .emission = true, .space = visibility_.needs_space()};
  }
  void prepare(const PrepareContext& context) override { visibility_.prepare(context); }
  void save(ByteWriter& out) const override { visibility_.save(out); }
  void load(ByteReader& in) override { visibility_.load(in); }

  std::vector<std::string> layers(std::span<const ImageLayer> wanted) override {
    std::vector<std::string> names;
    const auto take = [&](ImageLayer layer, int& index) {
      if (std::find(wanted.begin(), wanted.end(), layer) == wanted.end()) return;
      index = static_cast<int>(names.size());
      names.emplace_back(enum_name(layer));
    };
    take(ImageLayer::visibility_tests, tests_layer_);
    take(ImageLayer::negative, negative_layer_);
    return names;
  }

  std::vector<std::pair<std::string, double>> statistics() const override {
    auto stats = visibility_.statistics();
    stats.emplace_back("virtual_lights", lights_);
    if (random()) stats.emplace_back("lights_culled", culled_);
    stats.emplace_back("light_pass_cpu_seconds", seconds_.light);
    stats.emplace_back("visibility_cpu_seconds", seconds_.visibility);
    stats.emplace_back("eye_pass_cpu_seconds", seconds_.eye);
    return stats;
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    PassSeconds pass;
    VplSet lights(static_cast<std::size_t>(settings_.light_paths),
                  {settings_.max_depth - 1, by_lights(), least_alpha_});
    Counters counters;
    if (settings_.max_depth > (by_lights() ? 1 : 2)) counters = walk_lights(context, lights, image);
    lights.arrange([this](const VplGeometry& p) { return visibility_.group(p); });
    lights_ = static_cast<double>(lights.size());
    pass.end(seconds_.light);
    const VplContributions terms(lights, bound_of(settings_, context.scene.bounds().radius()));
    std::optional<LightDraw> draw;
    std::optional<LightFilter> filter;
    if (random()) draw.emplace(terms, *random());
    if (random() && random()->filter_radius > 0) filter.emplace(image, *random());
    for (const BlockRange& range : visibility_.passes(lights)) {
      if (lights.size() > 0) {
        counters += visibility_.begin(
            {.context = context,
             .terms = terms,
             .max_depth = settings_.max_depth,
             .least_alpha = least_alpha_,
             .lights = range,
             .sampled = random() ? std::size_t(random()->lights) : ~std::size_t{0}});
      }
      pass.end(seconds_.visibility);
      counters += gather(
          context, {terms, draw ? &*draw : nullptr, filter ? &*filter : nullptr, range}, image);
      pass.end(seconds_.eye);
    }
    if (draw) culled_ = draw->culled();
    if (filter) counters += add_filtered(context, *filter, image);
    pass.end(seconds_.eye);
    return counters;
  }

 private:
  static constexpr int batch_side = Tile::block_side;

  /// The bound of the geometric term, 1 / scene units^2.
  static float bound_of(const ManyLightsSettings& s, double radius) {
    switch (s.clamp) {
      case Clamp::relative:
        return static_cast<float>(s.bound / (radius * radius));
      case Clamp::absolute:
        return static_cast<float>(s.bound);
      case Clamp::off:
        break;
    }
    return std::numeric_limits<float>::infinity();
  }

  struct Direct {
    Rgb value;
    std::size_t path;
  };
  /// Working memory of a few pixels.
  struct Part {
    EyeBatch batch;
    LightGather<V> gather;
    EmittersAhead ahead = {};                     // emitters of next event estimation
    std::array<int, EyeBatch::size> shaded = {};  // edges to the shading point; 0: none yet
    std::array<LightSum, EyeBatch::size> sums = {};
    ShadowQueue<Direct> shadows = {};
    std::vector<ShadingPoint> points = {};
    std::vector<std::size_t> paths = {};  // of each of `points`
    std::vector<LightSum> of_points = {};
  };

  /// The data that all parts of a picture share.
  struct Gathering {
    const VplContributions& terms;
    LightDraw* draw;      // null: all lights
    LightFilter* filter;  // null: none
    BlockRange range;     // of this pass; what does not come from lights is added in the first
  };

  /// Samples the lights; null: all lights are gathered.
  const RandomLightsSettings* random() const {
    return std::get_if<RandomLightsSettings>(&settings_.gather);
  }

  /// Traces eye paths and gathers the lights at their shading points.
  Counters gather(const IterationContext& context, const Gathering& with, Image& image) const {
    const Tiling tiling(image, batch_side);
    Spares<Part> parts;
    const auto make = [&] {
      return std::make_unique<Part>(
          EyeBatch(settings_.max_depth),
          LightGather<V>(context, with.terms, visibility_, {with.draw, with.range}));
    };
    return for_each_part(context, tiling.tiles(), [&](int i, Counters& count) {
      parts.with(make, [&](Part& part) {
        part.shaded.fill(0);
        part.sums.fill({});
        start_paths(context, image, tiling.tile(i), part.batch);
        if (with.range.is_first()) count.samples += part.batch.states.size();
        trace(context, with, part, count);
        shine(with, part, count);
        add(context, with, part, image, count);
      });
    });
  }

  Counters add_filtered(const IterationContext& context, const LightFilter& filter,
                        Image& image) const {
    const Tiling tiling(image, batch_side);
    return for_each_part(context, tiling.tiles(), [&](int i, Counters& count) {
      const Tile tile = tiling.tile(i);
      for (int k = 0; k < tile.pixels(); ++k) {
        const V2i p = tile.pixel(k);
        Rgb& pixel = image.at(p.x, p.y);
        const V3d value = V3d(pixel) + filter.at(p);
        pixel = Rgb(0, 0, 0);
        count_negative(context, image.index(p.x, p.y), put(pixel, value, count));
      }
    });
  }

  Counters walk_lights(const IterationContext& context, VplSet& lights, Image& image) const {
    if (context.scene.emitters().empty()) return {};
    const LightPathSetting setting{context.scene,           context.camera,
                                   settings_.max_depth - 1, settings_.roulette_depth,
                                   SampleCounts{.hit = 0},  true};
    return light_pass(
        {context, setting, settings_.light_paths, image}, guide_,
        [&](std::size_t path, const LightBatch& batch, std::size_t place) {
          lights.keep(path, batch, place);
        },
        [](const Splat&) {});
  }

  /// Traces eye paths: emission, direct light, and the light that virtual lights leave to path
  /// tracing.
  void trace(const IterationContext& context, const Gathering& with, Part& part,
             Counters& counters) const {
    const DirectLight direct(context.scene, guide_, true, EmitterChoice::power);
    Walk walk(context.scene, guide_,
              {.max_depth = settings_.max_depth,
               .roulette_depth = settings_.roulette_depth,
               .packets = true},
              counters);
    const auto choose = [&](std::size_t i, int depth) {
      if (direct.draws() && depth < settings_.max_depth) {
        part.ahead[i] = direct.choose_ahead(part.batch.states[i].rng);
      }
    };
    walk.trace_paths(part.batch.states, choose, [&](std::size_t i, int depth) {
      return visit({context.scene, with, direct, part}, i, depth);
    });
    if (!with.range.is_first()) {
      part.shadows = {};
      part.batch.radiance.fill(Rgb(0, 0, 0));
      return;
    }
    part.shadows.flush(context.scene.rays(), counters,
                       [&](const Direct& d) { part.batch.radiance[d.path] += d.value; });
  }

  /// What the eye paths of a part are traced with.
  struct EyePass {
    const Scene& scene;
    const Gathering& with;
    const DirectLight& direct;
    Part& part;
  };
  /// Visits a vertex of eye path `i`; false where the path ends.
  bool visit(const EyePass& pass, std::size_t i, int depth) const {
    const Gathering& with = pass.with;
    const VplContributions& terms = with.terms;
    const DirectLight& direct = pass.direct;
    Part& part = pass.part;
    Vertex& v = part.batch.vertex(i, depth);
    const bool first = part.shaded[i] == 0;
    const Vertex& before = part.batch.vertex(i, depth - 1);
    // Virtual lights also sample this edge, except for the part above the bound.
    const bool shared = !first && depth == part.shaded[i] + 1 && !before.delta;
    if (shared && by_lights()) {
      part.batch.radiance[i] += emitted(pass.scene, v) * missing(terms, before, v);
    } else {
      part.batch.radiance[i] += direct.met(v, before, depth);
    }
    if (v.kind != Vertex::Kind::surface || depth == settings_.max_depth) return false;
    const bool lit_by_lights = v.bsdf->is_vpl_receiver(least_alpha_);
    if (!first && !settings_.compensation) return false;
    if (first && lit_by_lights) {
      part.shaded[i] = depth;
      if (!with.range.is_first()) return false;
    } else if (shared && lit_by_lights) {
      const float weight = missing(terms, before, v);
      if (weight == 0) return false;
      v.throughput *= weight;
      part.batch.states[i].throughput *= weight;
    }
    if (v.bsdf->connectible() && direct.draws() && !(first && lit_by_lights && by_lights())) {
      direct.draw(v, depth, part.ahead[i], part.batch.states[i].rng,
                  [&](const Ray& ray, const Rgb& value, const V3f&) {
                    part.shadows.add(ray, {value, i});
                  });
    }
    return settings_.compensation || !by_lights() || !lit_by_lights;
  }

  bool by_lights() const { return settings_.direct == DirectLighting::lights; }

  /// The share of the light from `to` that the bound of the geometric term removes.
  static float missing(const VplContributions& terms, const Vertex& at, const Vertex& to) {
    if (to.kind == Vertex::Kind::background) return 0;
    return 1 - terms.share(at, to, to.wp);
  }
  static Rgb emitted(const Scene& scene, const Vertex& v) {
    const std::optional<EmitterPoint> e = emitter_at(scene, v);
    return e ? v.throughput * e->emission : Rgb(0, 0, 0);
  }

  /// Gathers the lights at the part's shading points.
  void shine(const Gathering& with, Part& part, Counters& counters) const {
    part.points.clear();
    part.paths.clear();
    for (std::size_t i = 0; i < part.batch.states.size(); ++i) {
      const int depth = part.shaded[i];
      if (depth == 0 || depth >= settings_.max_depth) continue;
      part.points.emplace_back(part.batch.vertex(i, depth), depth, settings_.max_depth - 1 - depth,
                               part.batch.pixels[i]);
      part.paths.push_back(i);
    }
    part.of_points.assign(part.points.size(), {});
    part.gather.gather(part.points, part.of_points, counters);
    for (std::size_t k = 0; k < part.points.size(); ++k) {
      LightSum& sum = part.sums[part.paths[k]] = part.of_points[k];
      if (with.filter != nullptr) {
        with.filter->add(part.points[k], sum.value);
        sum.value = V3d(0, 0, 0);  // until all pixels are there
      }
    }
  }

  void add(const IterationContext& context, const Gathering& with, const Part& part, Image& image,
           Counters& counters) const {
    const double lights = static_cast<double>(std::max<std::size_t>(1, with.terms.lights().size()));
    for (std::size_t i = 0; i < part.batch.states.size(); ++i) {
      const std::uint32_t pixel = part.batch.pixels[i];
      const V3d value = V3d(part.batch.radiance[i]) + part.sums[i].value;
      const bool negative = put(image.pixels[pixel], value, counters);
      if (tests_layer_ >= 0) {
        const double share = static_cast<double>(part.sums[i].tests) / lights;
        layer(context, tests_layer_).pixels[pixel] += Rgb(static_cast<float>(share));
      }
      count_negative(context, pixel, negative);
    }
  }
  /// Writes a black pixel. Returns whether the value is negative.
  bool put(Rgb& pixel, const V3d& exact, Counters& counters) const {
    Rgb value(exact);
    const bool negative = value.x < 0 || value.y < 0 || value.z < 0;
    if (visibility_.clamps_negative()) {
      value = {std::max(0.0F, value.x), std::max(0.0F, value.y), std::max(0.0F, value.z)};
    }
    accumulate(pixel, value, counters);
    return negative;
  }
  void count_negative(const IterationContext& context, std::size_t pixel, bool negative) const {
    if (negative_layer_ < 0 || !negative) return;
    layer(context, negative_layer_).pixels[pixel] += Rgb(1);
  }
  static Image& layer(const IterationContext& context, int index) {
    return context.layers[static_cast<std::size_t>(index)];
  }

  Guide guide_;
  ManyLightsSettings settings_;
  float least_alpha_;
  V visibility_;
  int tests_layer_ = -1, negative_layer_ = -1;
  double lights_ = 0, culled_ = 0;
  struct {
    double light = 0, visibility = 0, eye = 0;
  } seconds_;
};

}  // namespace

std::unique_ptr<Integrator> make_many_lights(const ManyLightsSettings& settings) {
  return VisibilityRegistry::visit(
      settings.visibility,
      [&]<Visibility V>(const auto& visibility) -> std::unique_ptr<Integrator> {
        return std::make_unique<ManyLights<V>>(settings, visibility);
      });
}

}  // namespace lacuna
