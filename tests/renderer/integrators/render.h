#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "analysis/space/memory_limit.h"
#include "renderer/film/film.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/integrators/integrator.h"
#include "renderer/scene/scene_shape.h"
#include "tests/block_means.h"

namespace lacuna::test {

/// A picture made for a test, with all that it depends on.
struct Rendering {
  Film film;
  Counters counters;
  std::vector<std::vector<double>> blocks;  ///< block_means() of each iteration
  int textures_decoded = 0, filters = 0;
  bool emitters_built = false;

  /// Mean over pixels and channels, and the variance of that mean.
  double mean() const {
    double sum = 0;
    const std::vector<double> values = film.mean();
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
  /// Channels of a pixel are made from the same random numbers: their deviations add up, not their
  /// squares. Only where pixels are made apart from one another.
  double variance_of_mean() const {
    const std::vector<double> v = film.variance_of_mean();
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); i += 3) {
      const double deviation = std::sqrt(v[i]) + std::sqrt(v[i + 1]) + std::sqrt(v[i + 2]);
      sum += deviation * deviation;
    }
    const auto n = static_cast<double>(v.size());
    return sum / (n * n);
  }
};

struct RenderSettings {
  IntegratorSettings integrator = PathSettings{};
  int width = 32, height = 32;
  int iterations = 16;
  std::string camera = {};
  std::uint64_t seed = 1;
  Sampler sampler = Sampler::independent;
  int threads = 2;
  std::optional<EnvironmentImage> environment = {};
  PixelFilter filter = PixelFilter::box;
  int resolution = 24;  ///< of the analysis, voxels
  std::vector<ImageLayer> layers = {};
  std::vector<LightPathsLayer> light = {};
  PathObserver* observer = nullptr;
};

inline std::filesystem::path own_scene(const std::string& name) {
  return std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name;
}

/// An integrator that is ready to iterate on a scene.
class Session {
 public:
  Session(SceneData data, const RenderSettings& s)
      : Session(std::move(data), s, make_integrator(s.integrator)) {}
  /// With an integrator that no settings describe.
  Session(SceneData data, const RenderSettings& s, std::unique_ptr<Integrator> integrator)
      : settings_(s),
        pool_(s.threads),
        integrator_(std::move(integrator)),
        eye_(choose_camera(data, s.camera, "test")),
        camera_(eye_, s.width, s.height, s.filter),
        scene_(std::move(data), integrator_->needs(), s.environment, pool_) {
    integrator_->prepare({scene_, pool_, space_, camera_});
    names_ = integrator_->layers(s.layers);
    own_layers_ = names_.size();
    light_ = {std::ranges::find(s.layers, ImageLayer::lengths) != s.layers.end(), s.light,
              most_edges(s.integrator)};
    names_.insert(names_.end(), light_.names().begin(), light_.names().end());
  }

  /// `stop`: as IterationContext's.
  Image iterate(
      std::uint64_t i, const std::function<bool()>& stop = [] { return false; }) {
    Image image(camera_.width(), camera_.height());
    layers_.assign(names_.size(), image);
    counters_ += integrator_->iterate({.scene = scene_,
                                       .camera = camera_,
                                       .pool = pool_,
                                       .seed = settings_.seed,
                                       .iteration = i,
                                       .stop = stop,
                                       .layers = std::span(layers_).first(own_layers_),
                                       .sampler = settings_.sampler,
                                       .light = {light_, std::span(layers_).subspan(own_layers_)},
                                       .observer = settings_.observer},
                                      image);
    return image;
  }
  /// The layers that the integrator fills, and those of the latest iteration.
  const std::vector<std::string>& layer_names() const { return names_; }
  const std::vector<Image>& layers() const { return layers_; }
  Integrator& integrator() { return *integrator_; }
  const Scene& scene() const { return scene_; }
  const Counters& counters() const { return counters_; }
  const Camera& camera() const { return camera_; }

 private:
  RenderSettings settings_;
  std::size_t own_layers_ = 0;
  LightLayers light_;
  ThreadPool pool_;
  std::unique_ptr<Integrator> integrator_;
  CameraData eye_;
  Camera camera_;
  Scene scene_;
  ArtefactStore store_{{}};
  SpaceAnalysis space_{
      {.triangles = [this] { return triangle_soup(scene_.data()); },
       .geometry = geometry_key(scene_.data()),
       .seeds =
           [this] { return domain_seeds(scene_.data(), eye_, settings_.environment.has_value()); },
       .settings = {.resolution = settings_.resolution},
       .byte_limit = [] { return no_memory_limit; }},
      store_,
      pool_};
  std::vector<std::string> names_;
  std::vector<Image> layers_;
  Counters counters_;
};

inline Rendering render(SceneData data, const RenderSettings& s) {
  Session session(std::move(data), s);
  Rendering r;
  r.film = Film(session.camera().width(), session.camera().height());
  r.textures_decoded = session.scene().textures_decoded();
  r.filters = session.scene().rays().filters();
  r.emitters_built = session.scene().has_emitters();
  for (int i = 0; i < s.iterations; ++i) {
    const Image image = session.iterate(static_cast<std::uint64_t>(i));
    r.film.add(static_cast<std::uint64_t>(i), image);
    r.blocks.push_back(block_means(image));
  }
  r.counters = session.counters();
  return r;
}

inline Rendering render(const std::string& scene, const RenderSettings& s) {
  return render(load_gltf(own_scene(scene)), s);
}

}  // namespace lacuna::test
