#pragma once

#include <gtest/gtest.h>

#include "analysis/space/memory_limit.h"
#include "renderer/many_lights/cache_points.h"
#include "renderer/many_lights/light_gather.h"
#include "renderer/many_lights/shading_points.h"
#include "renderer/path/light_pass.h"
#include "renderer/scene/scene_shape.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna::test {

/// A scene with the virtual lights of one iteration and the shading points of a few pixels.
class LitScene {
 public:
  static constexpr int max_depth = 5;
  static constexpr float least_alpha = 0.09F;

  /// `seed`: of the lights and of the shading points.
  LitScene(const PathScene& named, int light_paths, float bound, bool with_emitters = true,
           std::uint64_t seed = 1)
      : seed_(seed),
        data_(load(named)),
        eye_(choose_camera(data_, "", "test")),
        camera_(eye_, 40, 30, PixelFilter::box),
        scene_(std::move(data_), {.materials = true, .emission = true}, environment(named), pool_),
        light_paths_(light_paths),
        with_emitters_(with_emitters),
        lights_(walk([](const VplGeometry&) { return 0U; })),
        terms_(lights_, bound) {}

  /// `visibility` sees the scene's empty space, and the lights in the groups that it wants.
  template <class Visibility>
  void prepare(Visibility& visibility) {
    visibility.prepare(prepare_context());
    lights_ = walk([&](const VplGeometry& p) { return visibility.group(p); });
    const IterationContext first = context(seed_);
    visibility.begin(pass(first));
  }
  PrepareContext prepare_context() { return {scene_, pool_, space_, camera_}; }
  SpaceAnalysis& space() { return space_; }
  const ThreadPool& pool() const { return pool_; }

  /// With random numbers of their own for each seed; the lights stay as they are.
  IterationContext context(std::uint64_t seed) const {
    return {scene_, camera_, pool_, seed, 0, never_};
  }
  const Scene& scene() const { return scene_; }
  const VplSet& lights() const { return lights_; }
  const VplContributions& terms() const { return terms_; }
  LightPass pass(const IterationContext& context) const {
    return {context, terms_, max_depth, least_alpha};
  }
  /// Vertices `index` of the light paths that are broad; of index 0, the emitters.
  std::size_t walked(int index) const { return walked_[static_cast<std::size_t>(index)]; }

  /// Calls `use(points)` with the shading points of the pixels `first` and the 63 after it.
  template <class Use>
  void with_points(std::uint32_t first, Use&& use) const {
    const IterationContext c = context(seed_);
    Counters counters;
    ShadingPoints finder(c, max_depth, least_alpha, counters);
    std::vector<std::uint32_t> pixels(EyeBatch::size);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      pixels[i] = (first + static_cast<std::uint32_t>(i)) % (40 * 30);
    }
    std::vector<ShadingPoint> points;
    finder.find(pixels, [&](const Vertex& v, int depth, std::uint32_t pixel) {
      points.emplace_back(v, depth, max_depth - 1 - depth, pixel);
    });
    use(std::span<const ShadingPoint>(points));
  }

 private:
  VplSet walk(const LightGroups& groups) {
    VplSet lights(static_cast<std::size_t>(light_paths_),
                  {max_depth - 1, with_emitters_, least_alpha});
    for (auto& n : walked_) n = 0;
    const LightPathSetting setting{
        scene_, camera_, max_depth - 1, max_depth, SampleCounts{.hit = 0}, true};
    Image image(40, 30);
    const IterationContext pass_context = context(seed_);
    light_pass(
        {pass_context, setting, light_paths_, image}, guide_,
        [&](std::size_t path, const LightBatch& batch, std::size_t place) {
          lights.keep(path, batch, place);
          const int length = std::min(batch.length(place), max_depth - 1);
          for (int i = 1; i < length; ++i) {
            walked_[static_cast<std::size_t>(i)] +=
                batch.vertex(place, i).bsdf->is_vpl_receiver(least_alpha);
          }
          if (length > 0) ++walked_[0];
        },
        [](const Splat&) {});
    lights.arrange(groups, pool_);
    return lights;
  }

  std::uint64_t seed_;
  ThreadPool pool_{2};
  std::function<bool()> never_ = [] { return false; };
  Guide guide_;
  SceneData data_;
  CameraData eye_;
  Camera camera_;
  Scene scene_;
  ArtefactStore store_{{}};
  SpaceAnalysis space_{{.triangles = [this] { return triangle_soup(scene_.data()); },
                        .geometry = geometry_key(scene_.data()),
                        .seeds = [this] { return domain_seeds(scene_.data(), eye_, false); },
                        .settings = {.resolution = 32},
                        .byte_limit = [] { return no_memory_limit; }},
                       store_,
                       pool_};
  std::array<std::atomic<std::size_t>, max_depth> walked_{};
  int light_paths_;
  bool with_emitters_;
  VplSet lights_;
  VplContributions terms_;
};

/// What the lights give to each point, red.
template <class Visibility>
std::vector<double> gathered(const LitScene& lit, const IterationContext& context,
                             const Visibility& visibility, std::span<const ShadingPoint> points,
                             std::uint64_t* tests = nullptr, const GatheredLights& from = {}) {
  Counters counters;
  std::vector<LightSum> sums(points.size());
  LightGather<Visibility>(context, lit.terms(), visibility, from).gather(points, sums, counters);
  std::vector<double> values;
  for (const LightSum& s : sums) {
    values.push_back(s.value.x);
    if (tests != nullptr) *tests += s.tests;
  }
  EXPECT_EQ(counters.rejected, 0U);
  return values;
}

}  // namespace lacuna::test
