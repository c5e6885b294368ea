#pragma once

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/tiles.h"

namespace lacuna {

/// Finds the shading points of an iteration's pixels: traces eye paths to the first vertex for
/// which Bsdf::is_vpl_receiver() holds.
class ShadingPoints {
 public:
  ShadingPoints(const IterationContext& context, int max_depth, float least_alpha,
                Counters& counters)
      : context_(context),
        max_depth_(max_depth),
        least_alpha_(least_alpha),
        batch_(max_depth),
        walk_(context.scene, guide_,
              {.max_depth = max_depth, .last_scatters = true, .roulette_depth = max_depth + 1},
              counters) {}

  /// Calls `use(vertex, depth, pixel)` for each of at most EyeBatch::size `pixels` with a shading
  /// point less than max_depth edges from the eye. The vertices are valid until the next call.
  template <class Use>
  void find(std::span<const std::uint32_t> pixels, Use&& use) {
    batch_.states.clear();
    for (const std::uint32_t pixel : pixels) {
      const CameraSample sample(context_, pixel);
      batch_.start(context_.camera, sample.rng, sample.ray, pixel);
    }
    walk_.trace_paths(batch_.states, [&](std::size_t i, int depth) {
      const Vertex& v = batch_.vertex(i, depth);
      if (v.kind != Vertex::Kind::surface || depth == max_depth_) return false;
      if (!v.bsdf->is_vpl_receiver(least_alpha_)) return true;
      use(v, depth, batch_.pixels[i]);
      return false;
    });
  }

 private:
  const IterationContext& context_;
  int max_depth_;
  float least_alpha_;
  Guide guide_;
  EyeBatch batch_;
  Walk walk_;
};

}  // namespace lacuna
