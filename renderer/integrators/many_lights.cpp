#include "renderer/integrators/integrators.h"

#include "base/parallel/spares.h"
#include "renderer/core/passes.h"
#include "renderer/many_lights/eye_pass.h"
#include "renderer/many_lights/light_filter.h"
#include "renderer/many_lights/light_gather.h"
#include "renderer/path/light_pass.h"
#include "renderer/settings/gather_settings.h"
#include "renderer/settings/many_lights_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/registry.h"

namespace lacuna {

namespace {

/// Many-light rendering (Noel 2015, 4.4): the first connectible vertex of every eye path gathers
/// all virtual lights. Path tracing continues from there for the light that they do not give.
template <Visibility V>
class ManyLights final : public Integrator {
 public:
  template <class Settings>
  ManyLights(const ManyLightsSettings& settings, const Settings& visibility)
      : settings_(settings),
        least_alpha_(static_cast<float>(settings.least_roughness * settings.least_roughness)),
        visibility_(visibility) {}

  SceneNeeds needs() const override {
    return {.materials = true, .emission = true, .space = visibility_.needs_space() || by_cubes()};
  }
  void prepare(const PrepareContext& context) override {
    visibility_.prepare(context);
    if (by_cubes()) scene_cubes_ = context.space.octree(CubeCulling::levels);
  }
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
    if (random()) {
      stats.emplace_back("lights_culled", culled_);
      stats.emplace_back("culling_tests", culling_tests_);
      if (by_cubes()) stats.emplace_back("light_leaves_culled", leaves_culled_);
    }
    stats.emplace_back("light_pass_cpu_seconds", seconds_.light);
    stats.emplace_back("visibility_cpu_seconds", seconds_.visibility);
    stats.emplace_back("eye_pass_cpu_seconds", seconds_.eye);
    return stats;
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    Passes passes(context.pool);
    passes.begin("light paths", seconds_.light);
    VplSet lights(static_cast<std::size_t>(settings_.light_paths),
                  {settings_.max_depth - 1, by_lights(), least_alpha_});
    Counters counters;
    if (settings_.max_depth > (by_lights() ? 1 : 2)) counters = walk_lights(context, lights, image);
    const auto cell_group = [this](const VplGeometry& p) -> LightGroup {
      const LightGroup group = visibility_.group(p);
      return clusters() ? group * visibility_.cells() + visibility_.cell(p) : group;
    };
    lights.arrange(cell_group, context.pool);
    lights_ = static_cast<double>(lights.size());
    passes.begin("visibility", seconds_.visibility);
    const VplContributions terms(lights, bound_of(settings_, context.scene.bounds().radius()));
    std::optional<VplSampler> sampler;
    std::optional<LightFilter> filter;
    std::optional<CubeCulling> cubes;
    if (by_cubes()) {
      cubes.emplace(lights, *scene_cubes_, static_cast<float>(random()->cutoff), context.pool);
      leaves_culled_ = cubes->culled();
    }
    if (random() && random()->filter_radius > 0) filter.emplace(image, *random());
    std::optional<VplTree> tree;
    std::optional<ClusterSampler> cluster_sampler;
    std::optional<Lightcuts> cuts;
    GatheredLights gathered;
    if (random()) {
      gathered.from = &sampler.emplace(terms, *random(), cubes ? &*cubes : nullptr);
    } else if (clusters()) {
      tree.emplace(lights, context.pool);
      gathered.from = &cluster_sampler.emplace(terms, *tree, *clusters());
    }
    for (const BlockRange& range : visibility_.passes(lights)) {
      passes.begin("visibility", seconds_.visibility);
      if (lights.size() > 0) {
        counters += visibility_.begin({.context = context,
                                       .terms = terms,
                                       .max_depth = settings_.max_depth,
                                       .least_alpha = least_alpha_,
                                       .lights = range,
                                       .sampled = sampled(lights.size()),
                                       .equal = !clusters() && !lightcuts()});
      }
      gathered.range = range;
      if (lightcuts()) {
        tree.emplace(lights, context.pool, range);
        gathered.from = &cuts.emplace(terms, *tree, *lightcuts(), context);
      }
      passes.begin("eye paths", seconds_.eye);
      counters += gather(context, {terms, gathered, filter ? &*filter : nullptr}, image);
    }
    visibility_.end();
    if (sampler) culled_ = sampler->culled(), culling_tests_ = double(sampler->tests());
    if (filter) counters += add_filtered(context, *filter, image);
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

  /// The data that all tiles of a picture share.
  struct Gathering {
    const VplContributions& terms;
    GatheredLights lights;  // of the range of this pass; the first pass adds all other light
    LightFilter* filter;    // null: none
  };

  /// The settings of light sampling; null: all lights are gathered.
  const RandomLightsSettings* random() const {
    return std::get_if<RandomLightsSettings>(&settings_.gather);
  }

  const LightcutsSettings* lightcuts() const {
    return std::get_if<LightcutsSettings>(&settings_.gather);
  }
  const ClusterLightsSettings* clusters() const {
    return std::get_if<ClusterLightsSettings>(&settings_.gather);
  }

  /// Whether octrees of the scene and of the lights cull lights.
  bool by_cubes() const {
    return random() && random()->cull && random()->cull_for == CullFor::cubes &&
           random()->interleave == 0;
  }
  /// Largest number of lights that a shading point gathers, of `lights`.
  std::size_t sampled(std::size_t lights) const {
    if (clusters()) return static_cast<std::size_t>(clusters()->lights);
    if (lightcuts()) return static_cast<std::size_t>(lightcuts()->most);
    if (!random()) return ~std::size_t{0};
    const auto step = static_cast<std::size_t>(random()->interleave * random()->interleave);
    return step > 0 ? (lights + step - 1) / step : static_cast<std::size_t>(random()->lights);
  }

  struct Part;
  void render(const Tile& tile, const IterationContext& context, const Gathering& with, Part& part,
              Image& image, Counters& counters) const;
  void gather_at_points(const IterationContext& context, const Gathering& with, Part& part,
                        Counters& counters) const;
  Counters gather(const IterationContext& context, const Gathering& with, Image& image) const;

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

  bool by_lights() const { return settings_.direct == DirectLighting::lights; }

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
  std::shared_ptr<const Octree> scene_cubes_;  // null: not by_cubes()
  double lights_ = 0, culled_ = 0, culling_tests_ = 0, leaves_culled_ = 0;
  struct {
    double light = 0, visibility = 0, eye = 0;
  } seconds_;
};

/// Working memory of a tile.
template <Visibility V>
struct ManyLights<V>::Part {
  VplEyePass::Memory eye;
  LightGather<V> gather;
  std::array<LightSum, EyeBatch::size> sums = {};  ///< of each path
  std::vector<LightSum> of_points = {};
};

/// Renders the eye paths of a tile, and the virtual lights at their shading points.
template <Visibility V>
void ManyLights<V>::render(const Tile& tile, const IterationContext& context, const Gathering& with,
                           Part& part, Image& image, Counters& counters) const {
  VplEyePass({settings_, least_alpha_, guide_, with.terms, with.lights.range.is_first()}, context,
             part.eye, counters)
      .trace(tile, image);
  part.sums.fill({});
  gather_at_points(context, with, part, counters);
  const EyeBatch& batch = part.eye.batch;
  const double lights = static_cast<double>(std::max<std::size_t>(1, with.terms.lights().size()));
  for (std::size_t i = 0; i < batch.states.size(); ++i) {
    const std::uint32_t pixel = batch.pixels[i];
    const V3d value = V3d(batch.radiance[i]) + part.sums[i].value;
    const bool negative = put(image.pixels[pixel], value, counters);
    if (tests_layer_ >= 0) {
      const double share = static_cast<double>(part.sums[i].tests) / lights;
      layer(context, tests_layer_).pixels[pixel] += Rgb(static_cast<float>(share));
    }
    count_negative(context, pixel, negative);
  }
}

/// Gathers the lights at the shading points of a tile.
template <Visibility V>
void ManyLights<V>::gather_at_points(const IterationContext& context, const Gathering& with,
                                     Part& part, Counters& counters) const {
  const std::vector<ShadingPoint>& points = part.eye.points;
  part.of_points.assign(points.size(), {});
  part.gather.gather(points, part.of_points, counters);
  for (std::size_t k = 0; k < points.size(); ++k) {
    LightSum& sum = part.sums[part.eye.paths[k]] = part.of_points[k];
    part.gather.for_each_length(k, [&](int edges, const V3d& value) {
      if (edges > points[k].edges) return;  // not gathered
      context.light.add(points[k].pixel, points[k].depth + 1 + edges, 0, Rgb(value));
    });
    if (with.filter != nullptr) {
      with.filter->add(points[k], sum.value);
      sum.value = V3d(0, 0, 0);  // add_filtered() adds it when all pixels have been gathered
    }
  }
}

/// Renders all eye paths.
template <Visibility V>
Counters ManyLights<V>::gather(const IterationContext& context, const Gathering& with,
                               Image& image) const {
  const Tiling tiling(image, batch_side);
  Spares<Part> parts;
  const auto make = [&] {
    return std::make_unique<Part>(VplEyePass::Memory(settings_.max_depth),
                                  LightGather<V>(context, with.terms, visibility_, with.lights));
  };
  return for_each_part(context, tiling.tiles(), [&](int i, Counters& count) {
    parts.with(make,
               [&](Part& part) { render(tiling.tile(i), context, with, part, image, count); });
  });
}

}  // namespace

std::unique_ptr<Integrator> make_many_lights(const ManyLightsSettings& settings) {
  return VisibilityRegistry::visit(
      settings.visibility,
      [&]<Visibility V>(const auto& visibility) -> std::unique_ptr<Integrator> {
        return std::make_unique<ManyLights<V>>(settings, visibility);
      });
}

}  // namespace lacuna
