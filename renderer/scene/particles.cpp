#include "renderer/scene/particles.h"

#include <cmath>

#include "renderer/core/rng.h"
#include "renderer/core/sampling.h"

namespace lacuna {

void add_particles(SceneData& scene, const ParticleSettings& settings) {
  const Bounds box = scene.meshes.empty() ? Bounds{V3d(0.0), V3d(0.0)} : scene.bounds();
  if (settings.alone) scene.lights.clear();
  const double intensity = settings.power / (4 * double(pi) * settings.count);
  PunctualLight light;
  light.name = "particle";
  light.intensity = Rgb(V3d(settings.color[0], settings.color[1], settings.color[2]) * intensity);
  Rng rng(static_cast<std::uint64_t>(settings.seed), 0, 0, Rng::Purpose::particles);
  scene.lights.reserve(scene.lights.size() + static_cast<std::size_t>(settings.count));
  for (int i = 0; i < settings.count; ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const double share = std::lerp(settings.low[axis], settings.high[axis], double(rng.next()));
      light.position[k] = static_cast<float>(std::lerp(box.low[k], box.high[k], share));
    }
    scene.lights.push_back(light);
  }
}

}  // namespace lacuna
