#include "renderer/connections/eye_records.h"

#include <fmt/format.h>

#include "renderer/core/free_memory.h"
#include "renderer/path/eye_batch.h"

namespace lacuna {

void EyeRecords::place(const IterationContext& context, const LightVertices& lights, double density,
                       int deepest, Counters& counters) {
  records_.clear();
  const int longest = std::min(lights.longest(), deepest);
  const int width = context.camera.width();
  const auto pixels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(context.camera.height());
  const auto paths = static_cast<std::uint64_t>(std::ceil(density * static_cast<double>(pixels)));
  EyeBatch batch(longest);
  const Guide guide;
  Walk walk(context.scene, guide,
            {.max_depth = longest,
             .last_scatters = true,
             .roulette_depth = longest + 1,
             .counts = eye_side(lights.counts())},
            counters);
  for (std::uint64_t first = 0; first < paths; first += EyeBatch::size) {
    context.check_stop();
    batch.states.clear();
    for (std::uint64_t j = first; j < std::min(paths, first + EyeBatch::size); ++j) {
      Rng rng(context.seed, context.iteration, j, Rng::Purpose::eye_records);
      const std::uint64_t pixel = rng.below(pixels);
      const V2i p(static_cast<int>(pixel % static_cast<std::uint64_t>(width)),
                  static_cast<int>(pixel / static_cast<std::uint64_t>(width)));
      const Ray ray = context.camera.sample(p, rng.next2(), rng);
      batch.start(context.camera, rng, ray, pixel);
    }
    walk.trace_paths(batch.states, [&](std::size_t i, int depth) {
      const Vertex& v = batch.vertex(i, depth);
      if (v.kind == Vertex::Kind::surface && v.bsdf->connectible()) records_.push_back({v, depth});
    });
  }
  std::vector<SurfacePoint> points;
  points.reserve(records_.size());
  for (const Record& r : records_) points.push_back(surface_point(r.vertex));
  tree_.build(std::move(points));
}

RecordContributions contributions_to(const EyeRecords::Record& record,
                                     const IterationContext& context, const LightVertices& lights,
                                     int s, const WantedContributions& wanted) {
  const Guide guide;
  Vertex unit = record.vertex;  // contributions to the record, independent of its pixel
  unit.throughput = Rgb(1, 1, 1);
  const SurfaceEndpoint eye{unit, record.depth, Transport::radiance, guide};
  const auto finite = [](double w) { return std::isfinite(w) ? w : 0.0; };
  const std::size_t n = lights.count(s);
  RecordContributions all{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0),
                          std::vector<double>(n, 0.0)};
  std::vector<Ray> rays;
  std::vector<std::size_t> traced;
  for (std::size_t i = 0; i < n; ++i) {
    lights.with_end(s, i, guide, [&](const auto& light) {
      const Connection c = connect(eye, light);
      if (!c) return;
      if (wanted.bounded) all.bounded[i] = finite(double(luminance(light.scatter(-c.w))));
      const double weighted = wanted.weighted ? weight(eye, light, c, lights.counts()) : 1.0;
      const double w = finite(double(luminance(c.contribution)) * weighted);
      if (wanted.unshadowed) all.unshadowed[i] = w;
      if (!wanted.full) return;
      all.full[i] = w;
      traced.push_back(i);
      rays.push_back(shadow_ray(eye, light, c));
    });
  }
  std::vector<std::uint8_t> occluded(rays.size());
  context.scene.rays().occluded(rays, occluded);
  all.rays = rays.size();
  for (std::size_t k = 0; k < traced.size(); ++k) {
    if (occluded[k] != 0) all.full[traced[k]] = 0;
  }
  return all;
}

void require_distributions(std::string_view who, std::size_t records, std::size_t bytes_each,
                           const LightVertices& lights) {
  double bytes = 0;
  for (int s = 1; s <= lights.longest(); ++s) {
    bytes += static_cast<double>(records) * static_cast<double>(lights.count(s)) *
             static_cast<double>(bytes_each);
  }
  require_free(bytes, [&] {
    return fmt::format(
        "{}: the distributions of {} records over {} light paths; lower record_density or "
        "light_paths",
        who, records, lights.paths());
  });
}

}  // namespace lacuna
