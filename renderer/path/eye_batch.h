#pragma once

#include <algorithm>
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

  /// Adds a path: `ray` is the camera ray through `pixel`; `rng` supplies the random numbers of all
  /// later edges.
  void start(const Camera& camera, const Rng& rng, const Ray& ray, std::size_t pixel) {
    const std::size_t i = states.size();
    const std::span<Vertex> path = std::span(vertices).subspan(i * stride, stride);
    // Parallel rays come from infinity, as to_area() measures them.
    path[0].kind = camera.parallel() ? Vertex::Kind::background : Vertex::Kind::eye;
    path[0].surface.x = camera.parallel() ? -ray.d : ray.o;
    // The eye's density and its importance cancel: the throughput is 1.
    states.push_back({.rng = rng, .ray = ray, .p = camera.density(ray.d), .path = path});
    pixels[i] = static_cast<std::uint32_t>(pixel);
    origin[i] = static_cast<std::uint8_t>(i);
    radiance[i] = Rgb(0, 0, 0);
  }

  /// Whether branches keep all vertices of the path that was split, for a PathObserver.
  void keep_whole_paths(bool keep) { whole_ = keep; }
  /// Stores the branches of the batch's paths for resume().
  void store(std::vector<PathBranch>& branches) {
    for (PathBranch& b : branches) {
      const std::size_t i = b.walk;
      const auto before = whole_ ? static_cast<std::size_t>(b.state.depth) : 0;
      const auto first = vertices.begin() + static_cast<std::ptrdiff_t>(i * stride);
      std::vector<Vertex> path(first, first + static_cast<std::ptrdiff_t>(before));
      pending_.push_back({std::move(b), pixels[i], origin[i], std::move(path)});
    }
    branches.clear();
  }

  /// Replaces the paths by stored branches, as many as fit; false if there are none. Only the
  /// vertex at which a branch begins is written: the vertices before it stay those of the path that
  /// had its index before. Call when all contributions of the current paths have been added.
  bool resume() {
    states.clear();
    while (!pending_.empty() && states.size() < size) {
      Pending& p = pending_.back();
      const std::size_t i = states.size();
      PathState w = p.branch.state;
      w.path = std::span(vertices).subspan(i * stride, stride);
      std::ranges::copy(p.before, w.path.begin());
      w.path[static_cast<std::size_t>(w.depth)] = std::move(p.branch.vertex);
      states.push_back(w);
      pixels[i] = p.pixel;
      origin[i] = p.origin;
      radiance[i] = Rgb(0, 0, 0);
      pending_.pop_back();
    }
    return !states.empty();
  }

  const Vertex& vertex(std::size_t i, int depth) const {
    return vertices[i * stride + static_cast<std::size_t>(depth)];
  }

  /// The vertices 0 to `last` of path `i`, for a PathObserver.
  std::vector<const Vertex*> path_to(std::size_t i, int last) const {
    std::vector<const Vertex*> path;
    for (int depth = 0; depth <= last; ++depth) path.push_back(&vertex(i, depth));
    return path;
  }

  Vertex& vertex(std::size_t i, int depth) {
    return vertices[i * stride + static_cast<std::size_t>(depth)];
  }

  std::size_t stride;  // vertices of one path
  std::vector<Vertex> vertices;
  std::vector<PathState> states;
  std::array<std::uint32_t, size> pixels{};
  std::array<std::uint8_t, size> origin{};  ///< index of the path that start() added
  std::array<Rgb, size> radiance{};

 private:
  struct Pending {
    PathBranch branch;
    std::uint32_t pixel;
    std::uint8_t origin;
    std::vector<Vertex> before;  // vertices, if they are kept
  };
  bool whole_ = false;
  std::vector<Pending> pending_;
};

}  // namespace lacuna
