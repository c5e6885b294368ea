#include "renderer/scene/delta_surfaces.h"

#include <fmt/format.h>

namespace lacuna {

namespace {

/// The number of camera rays, `across` in each dimension of the film.
constexpr int across = 64, ray_count = across * across;

/// How many rays hit a kind of surface, and an example.
struct SurfaceCount {
  int count = 0;
  std::string example;

  void add(const Scene& scene, const Surface& s) {
    if (count++ > 0) return;
    example = fmt::format("material \"{}\" of mesh \"{}\"", scene.material(s).name,
                          scene.data().meshes[s.mesh].name);
  }
};

}  // namespace

std::vector<std::string> missing_reflections(const Scene& scene, const Camera& camera) {
  SurfaceCount black, coated;
  for (int i = 0; i < ray_count; ++i) {
    const auto at = [](int k, int size) {
      return (static_cast<float>(k) + 0.5F) / across * static_cast<float>(size);
    };
    const Ray ray = camera.ray(at(i % across, camera.width()), at(i / across, camera.height()));
    Hit hit;
    if (!scene.rays().intersect(ray, hit)) continue;
    const Surface s = scene.surface(ray, hit);
    std::optional<Bsdf> bsdf;
    scene.make_bsdf(s, bsdf);
    if (!bsdf->delta(-ray.d, false) && !bsdf->delta(-ray.d, true)) continue;
    (bsdf->connectible() ? coated : black).add(scene, s);
  }
  std::vector<std::string> warnings;
  if (black.count > 0) {
    warnings.push_back(fmt::format(
        "mirrors and clear glass are black: paths from the lights cannot be connected to the eye "
        "there; {:.2g} % of the picture, first {}; another integrator shows them",
        100.0 * black.count / ray_count, black.example));
  }
  if (coated.count > 0) {
    warnings.push_back(fmt::format(
        "smooth coats lack their reflections: paths from the lights cannot be connected to the eye "
        "there; {:.2g} % of the picture, first {}; another integrator shows them",
        100.0 * coated.count / ray_count, coated.example));
  }
  return warnings;
}

}  // namespace lacuna
