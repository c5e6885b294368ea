#include "renderer/connections/importance_cache.h"

#include <fmt/format.h>

#include <numeric>

#include "renderer/core/free_memory.h"
#include "renderer/path/eye_batch.h"

namespace lacuna {

void ImportanceCacheConnections::place_records(const IterationContext& context, int longest,
                                               Counters& counters) {
  records_.clear();
  const int width = context.camera.width();
  const auto pixels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(context.camera.height());
  const auto paths =
      static_cast<std::uint64_t>(std::ceil(settings_.record_density * static_cast<double>(pixels)));
  EyeBatch batch(longest);
  Walk<BsdfGuide> walk(context.scene, guide_,
                       {.max_depth = longest, .last_scatters = true, .roulette_depth = longest + 1},
                       counters);
  for (std::uint64_t first = 0; first < paths; first += EyeBatch::size) {
    context.check_stop();
    batch.states.clear();
    for (std::uint64_t j = first; j < std::min(paths, first + EyeBatch::size); ++j) {
      Rng rng(context.seed, context.iteration, j, Rng::Purpose::integrator);
      const std::uint64_t pixel = rng.below(pixels);
      const V2i p(static_cast<int>(pixel % static_cast<std::uint64_t>(width)),
                  static_cast<int>(pixel / static_cast<std::uint64_t>(width)));
      batch.start(context.camera, rng, context.camera.sample(p, rng.next2()), pixel);
    }
    walk.trace_paths(
        batch.states, [](std::size_t, int) {},
        [&](std::size_t i, int depth) {
          const Vertex& v = batch.vertex(i, depth);
          if (v.kind == Vertex::Kind::surface && v.bsdf->connectible()) records_.push_back(v);
        });
  }
}

void ImportanceCacheConnections::begin(const IterationContext& context, const LightVertices& lights,
                                       const CellStatistics&, Counters& counters) {
  place_records(context, std::min(lights.longest(), record_depth_), counters);
  double bytes = 0;
  for (int s = 1; s <= lights.longest(); ++s) {
    bytes += static_cast<double>(records_.size()) * static_cast<double>(lights.count(s)) *
             static_cast<double>(ResamplingTable::bytes_each);
  }
  require_free(bytes, [&] {
    return fmt::format(
        "importance_cache: the distributions of {} records over {} light paths; lower "
        "record_density or light_paths",
        records_.size(), lights.paths());
  });
  std::vector<SurfacePoint> points;
  for (const Vertex& v : records_) points.push_back(surface_point(v));
  tree_.build(std::move(points));
  cells_of_records_.resize(records_.size());
  std::vector<std::uint64_t> rays(records_.size());
  context.pool.for_each(static_cast<int>(records_.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    rays[k] = build(records_[k], cells_of_records_[k], context, lights);
  });
  counters.shadow_rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t ImportanceCacheConnections::build(const Vertex& record, ResamplingCell& cell,
                                                const IterationContext& context,
                                                const LightVertices& lights) const {
  Vertex unit = record;  // what light gives to the record, whatever the record gives to a pixel
  unit.throughput = Rgb(1, 1, 1);
  const SurfaceEndpoint<BsdfGuide> eye{unit, 1, Transport::radiance, guide_};
  const auto finite = [](double w) { return std::isfinite(w) ? w : 0.0; };
  std::vector<Ray> rays;
  std::vector<std::size_t> traced;
  std::vector<std::uint8_t> occluded;
  std::uint64_t sent = 0;
  for (int s = 1; s <= lights.longest(); ++s) {
    context.check_stop();
    const std::size_t n = lights.count(s);
    std::vector<double> full(n, 0.0), unshadowed(n, 0.0), bounded(n, 0.0);
    const std::vector<double> same(n, 1.0);
    rays.clear();
    traced.clear();
    for (std::size_t i = 0; i < n; ++i) {
      lights.with_end(s, i, guide_, [&](const auto& light) {
        const Connection c = connect(eye, light);
        if (!c) return;
        if (settings_.bounded) bounded[i] = finite(double(luminance(light.scatter(-c.w))));
        const double w = finite(double(luminance(c.contribution)));
        if (settings_.unshadowed) unshadowed[i] = w;
        if (!settings_.full) return;
        full[i] = w;
        traced.push_back(i);
        rays.push_back(shadow_ray(eye, light, c));
      });
    }
    occluded.resize(rays.size());
    context.scene.rays().occluded(rays, occluded);
    sent += rays.size();
    for (std::size_t k = 0; k < traced.size(); ++k) {
      if (occluded[k] != 0) full[traced[k]] = 0;
    }
    const std::array<std::span<const double>, 4> all{full, unshadowed, bounded, same};
    cell.set(s, ResamplingTable(all, settings_.combination));
  }
  return sent;
}

}  // namespace lacuna
