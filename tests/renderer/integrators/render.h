#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "renderer/film/film.h"
#include "renderer/integrators/integrator.h"

namespace lacuna::test {

/// A picture made for a test, with all that it depends on.
struct Rendering {
  Film film;
  Counters counters;
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
  /// squares.
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
  int threads = 2;
  std::optional<EnvironmentImage> environment = {};
};

inline std::filesystem::path own_scene(const std::string& name) {
  return std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name;
}

inline Rendering render(SceneData data, const RenderSettings& s) {
  const ThreadPool pool(s.threads);
  const auto integrator = make_integrator(s.integrator);
  const Camera camera(choose_camera(data, s.camera, "test"), s.width, s.height);
  const Scene scene(std::move(data), integrator->needs(), s.environment, pool);
  Rendering r;
  r.film = Film(s.width, s.height);
  r.textures_decoded = scene.textures_decoded();
  r.filters = scene.rays().filters();
  r.emitters_built = scene.has_emitters();
  const std::function<bool()> never = [] { return false; };
  for (int i = 0; i < s.iterations; ++i) {
    Image image(s.width, s.height);
    r.counters += integrator->iterate(
        {scene, camera, pool, s.seed, static_cast<std::uint64_t>(i), never}, image);
    r.film.add(static_cast<std::uint64_t>(i), image);
  }
  return r;
}

inline Rendering render(const std::string& scene, const RenderSettings& s) {
  return render(load_gltf(own_scene(scene)), s);
}

}  // namespace lacuna::test
