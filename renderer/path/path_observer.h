#pragma once

#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "renderer/path/vertex.h"

namespace lacuna {

/// A vertex of a traced path.
struct TracedVertex {
  V3f x{0, 0, 0};         ///< position; at infinity: the unit direction to there
  bool infinite = false;  ///< at infinity
  bool from_light = false;
  double density = 0;  ///< on its walk, per area; at infinity per steradian; 0 at the eye
};

/// A path that has contributed to a pixel, from the eye to the light.
struct TracedPath {
  std::uint64_t iteration = 0;
  int s = 0, t = 0;          ///< vertices sampled from the light and from the eye
  Rgb value{0, 0, 0};        ///< its contribution to the pixel in that iteration
  float weight = 0;          ///< MIS; `value` includes it
  std::string letters = {};  ///< E, what each vertex does (D, G, S), L
  std::vector<TracedVertex> vertices = {};
};

/// Collects the paths that contribute to one pixel while iterations are rendered as always.
class PathObserver {
 public:
  explicit PathObserver(std::uint32_t pixel) : pixel_(pixel) {}

  std::uint32_t pixel() const { return pixel_; }
  bool watches(std::size_t pixel) const { return pixel == pixel_; }

  /// Adds a path of these vertices, those at the eye and on the emitter first, whose shadow ray is
  /// not traced yet; without vertices from the light, the last one from the eye is on an emitter.
  /// Without any, it stands for several paths of one edge. Returns its number, above 0. Several
  /// threads may call it.
  std::uint32_t add(TracedPath path, std::span<const Vertex* const> from_eye,
                    std::span<const Vertex* const> from_light);
  /// Path `number` is not occluded, and contributes TracedPath::value, or `value`.
  void arrived(std::uint32_t number);
  void arrived(std::uint32_t number, const Rgb& value);
  /// The paths that have arrived, in the order of their values, and forgets all.
  std::vector<TracedPath> take();

 private:
  struct Kept {
    TracedPath path;
    bool arrived = false;
  };
  std::uint32_t pixel_;
  std::mutex mutex_;
  std::vector<Kept> kept_;
};

}  // namespace lacuna
