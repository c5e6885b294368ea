#include "renderer/integrators/merging_bdpt.h"

#include "base/parallel/clock_seconds.h"
#include "renderer/path/merge.h"

namespace lacuna {

void MergingBdpt::look_up(const TilePass& pass, EyePaths& batch, LookUps& look_ups) const {
  if (look_ups.all.empty()) return;
  const SampleCounts& counts = batch.counts;
  const double begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  for (const LookUps::At& at : look_ups.all) {
    look_ups.stop.check(pass.context);
    const Vertex& v = batch.vertex(at.path, at.depth);
    const SurfaceEndpoint eye{v, at.depth, Transport::radiance, guide_};
    const std::uint32_t pixel = batch.pixels[at.path];
    const LightSink& light = pass.context.light;
    Rgb sum(0, 0, 0);
    // Eye and light have each met a blended surface with probability alpha: once too often.
    const float covered = pass.context.scene.coverage(v.surface);
    photons_.for_each_at(v, batch.states[at.path].rng, [&](const Photon& p, float, float count) {
      if (p.index + at.depth > settings_.max_depth) return;
      const Rgb value = merged(eye, p) * static_cast<float>(double(count) / counts.merge);
      if (is_black(value)) return;
      const auto w = static_cast<float>(merge_weight(eye, p, counts));
      sum += value * w;
      layers_.merge(pass.context.layers, p.index + 1, at.depth + 1, {pixel, value / covered, w});
      if (!light) return;
      const auto matches = matches_beyond(light.automaton(), eye, p.wp, p.letters);
      light.add(pixel, p.index + at.depth, matches, value * w / covered);
    });
    sum /= covered;
    contribute(pass, batch, at.path, at.depth, sum);
  }
  look_ups.all.clear();
  look_ups.seconds += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
}

}  // namespace lacuna
