#pragma once

#include "renderer/film/image.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna::test {

/// Plates that do not touch, so that no connection is short: with all weights 1 the noise stays
/// finite. Every strategy can make every path.
inline SceneData plates() {
  SceneParts p;
  const auto plate = p.material(diffuse(Rgb(0.8F, 0.7F, 0.6F)));
  Material shining = diffuse(Rgb(0.5F));
  shining.emission = Rgb(2, 3, 4);
  p.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, plate);
  p.quad({-1, 0.5F, -1.6F}, {2, 0, 0}, {0, 1.2F, 0}, plate);
  p.quad({1.5F, 0.4F, 1}, {0, 0, -2}, {0, 1.2F, 0}, p.material(metal(Rgb(0.9F), 0.7F)));
  p.quad({-0.6F, 2.2F, -0.6F}, {1.2F, 0, 0}, {0, 0, 1.2F}, p.material(shining));
  p.eye({0.2, 1.1, 3.2}, {0, 0.9, -0.5}, 1.1);
  return std::move(p.data);
}

/// Over all pixels and channels.
inline double sum_of(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(p.x) + double(p.y) + double(p.z);
  return sum;
}

}  // namespace lacuna::test
