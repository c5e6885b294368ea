#pragma once

#include <array>

#include "renderer/path/walk.h"
#include "renderer/scene/camera.h"

namespace lacuna {

/// Eye paths of neighbouring pixels that are traced together, and the radiance that each gathers.
struct EyeBatch {
  static constexpr std::size_t size = 64;  // their vertices fit the second-level cache

  explicit EyeBatch(int max_depth)
      : stride(static_cast<std::size_t>(max_depth) + 1), vertices(stride * size) {
    states.reserve(size);
  }

  /// Adds a path: `ray` is the camera ray through `pixel`, `rng` draws everything after it.
  void start(const Camera& camera, const Rng& rng, const Ray& ray, std::size_t pixel) {
    const std::size_t i = states.size();
    const std::span<Vertex> path = std::span(vertices).subspan(i * stride, stride);
    path[0].kind = Vertex::Kind::eye;
    path[0].surface.x = ray.o;
    // The eye's density and its importance cancel: the throughput is 1.
    states.push_back({.rng = rng, .ray = ray, .p = camera.density(ray.d), .path = path});
    pixels[i] = static_cast<std::uint32_t>(pixel);
    radiance[i] = Rgb(0, 0, 0);
  }

  const Vertex& vertex(std::size_t i, int depth) const {
    return vertices[i * stride + static_cast<std::size_t>(depth)];
  }

  Vertex& vertex(std::size_t i, int depth) {
    return vertices[i * stride + static_cast<std::size_t>(depth)];
  }

  std::size_t stride;  // vertices of one path
  std::vector<Vertex> vertices;
  std::vector<PathState> states;
  std::array<std::uint32_t, size> pixels{};
  std::array<Rgb, size> radiance{};
};

}  // namespace lacuna
