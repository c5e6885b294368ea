#pragma once

#include <vector>

#include "renderer/path/guide.h"
#include "renderer/path/light_vertices.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna::test {

/// The light vertices of a scene, as an iteration keeps them, and the walks they come from.
struct Lit {
  static constexpr int most_edges = 5, paths = 256;
  static constexpr SampleCounts counts{1, 1, 1, 64};

  explicit Lit(const PathScene& s)
      : data(load(s)),
        camera(data.cameras.front(), 8, 8),
        scene(lit_scene(std::move(data), environment(s))) {
    const LightPathSetting setting{scene, camera, most_edges, most_edges + 1, counts};
    LightBatch batch(setting, guide);
    Counters counters;
    for (std::uint64_t first = 0; first < paths; first += LightBatch::size) {
      std::vector<Rng> rngs;
      for (std::uint64_t j = 0; j < LightBatch::size; ++j) {
        rngs.emplace_back(101, 0, first + j, Rng::Purpose::light_path);
      }
      batch.walk(rngs, counters);
      for (std::size_t k = 0; k < rngs.size(); ++k) {
        lights.keep(first + k, batch, k);
        std::vector<Vertex> path;
        for (int i = 1; i < batch.length(k); ++i) path.push_back(batch.vertex(k, i));
        walked.push_back(std::move(path));
      }
    }
    lights.arrange();
  }

  SceneData data;
  Camera camera;
  Scene scene;
  Guide guide;
  LightVertices lights{paths, most_edges - 1, counts};
  std::vector<std::vector<Vertex>> walked;  ///< of each path vertices 2, 3, ...
};

}  // namespace lacuna::test
