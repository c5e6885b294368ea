// Rays per CPU second of integrator `path`, as a share of what a bare loop reaches that sends the
// same rays through Embree: camera rays, bounces and shadow rays, recorded from the walk itself, in
// the same order.
//
//   bench_rays SCENE.glb WIDTH HEIGHT MAX_DEPTH ROUNDS

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>

#include "renderer/guides/bsdf_guide.h"
#include "renderer/integrators/integrator.h"
#include "renderer/path/connect.h"
#include "renderer/path/walk.h"

namespace {

using namespace lacuna;

struct RecordedRay {
  Ray ray;
  bool shadow;
};
using Recording = std::vector<std::vector<RecordedRay>>;  // a list for each tile

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The rays of one iteration of `path` with these settings.
Recording record(const Scene& scene, const Camera& camera, const V2i& size,
                 const PathSettings& settings) {
  constexpr int tile = 32;
  const BsdfGuide guide;
  Recording recording;
  std::vector<Vertex> path(static_cast<std::size_t>(settings.max_depth) + 1);
  for (int y0 = 0; y0 < size.y; y0 += tile) {
    for (int x0 = 0; x0 < size.x; x0 += tile) {
      auto& rays = recording.emplace_back();
      for (int i = 0; i < tile * tile; ++i) {
        const int x = x0 + i % tile;
        const int y = y0 + i / tile;
        if (x >= size.x || y >= size.y) continue;
        Rng rng(1, 0,
                static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(size.x) +
                    static_cast<std::uint64_t>(x));
        const Ray first = camera.sample(V2i(x, y), rng.next2());
        path[0].surface.x = first.o;
        Ray next = first;
        Counters counters;
        std::uint32_t chosen = 0;
        std::array<Walker, 1> walker{Walker{rng, first, Pdf<SolidAngle>(1.0F), path}};
        Walk walk(scene, guide, {settings.max_depth, settings.roulette_depth}, counters);
        walk.lead(
            walker,
            [&](std::size_t, int depth) {
              if (depth < settings.max_depth) chosen = scene.emitters().choose(walker[0].rng);
            },
            [&](std::size_t, int depth) {
              const Vertex& v = path[static_cast<std::size_t>(depth)];
              if (depth > 1) {
                const Surface& s = path[static_cast<std::size_t>(depth) - 1].surface;
                next = {offset_origin(s.x, s.ng, s.extent, -v.wp), -v.wp};
              }
              rays.push_back({next, false});
              if (v.kind != Vertex::Kind::surface || depth == settings.max_depth ||
                  !v.bsdf->connectible()) {
                return;
              }
              const EmitterSample e = scene.emitters().sample(chosen, v.surface.x, walker[0].rng);
              if (is_black(connect(v, e).contribution)) return;
              rays.push_back({scene.shadow_ray(v.surface, e), true});
            });
      }
    }
  }
  return recording;
}

/// The bare loop: fills Embree's own structures and calls it, nothing else.
std::uint64_t send(RTCScene scene, const std::vector<RecordedRay>& rays) {
  std::uint64_t hits = 0;
  for (const RecordedRay& r : rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = {r.ray.o.x, r.ray.o.y, r.ray.o.z,  0.0F, r.ray.d.x, r.ray.d.y,
                 r.ray.d.z, 0.0F,      r.ray.tmax, ~0U,  0,         0};
    if (r.shadow) {
      rtcOccluded1(scene, &context, &query.ray);
      hits += query.ray.tfar < 0 ? 1 : 0;
    } else {
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &context, &query);
      hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
    }
  }
  return hits;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    fmt::print(stderr, "usage: bench_rays SCENE.glb WIDTH HEIGHT MAX_DEPTH ROUNDS\n");
    return 2;
  }
  const V2i size(std::atoi(argv[2]), std::atoi(argv[3]));
  PathSettings settings;
  settings.max_depth = std::atoi(argv[4]);
  const int rounds = std::atoi(argv[5]);

  const ThreadPool pool(0);
  const auto integrator = make_integrator(settings);
  const Scene scene(load_gltf(argv[1]), integrator->needs(), std::nullopt, pool);
  const Camera camera(scene.data().cameras.front(), size.x, size.y);
  const Recording recording = record(scene, camera, size, settings);
  double sent = 0;
  double shadow = 0;
  for (const auto& tile : recording) {
    sent += static_cast<double>(tile.size());
    for (const auto& r : tile) shadow += r.shadow ? 1 : 0;
  }

  std::vector<double> bare, whole, ratio;
  std::vector<std::uint64_t> hits(recording.size());
  const std::function<bool()> never = [] { return false; };
  for (int round = 0; round <= rounds; ++round) {
    double start = cpu_seconds();
    pool.for_each(static_cast<int>(recording.size()), [&](int i) {
      hits[static_cast<std::size_t>(i)] =
          send(scene.rays().embree_scene(), recording[static_cast<std::size_t>(i)]);
    });
    const double bare_rate = sent / (cpu_seconds() - start);
    Image image(size.x, size.y);
    start = cpu_seconds();
    const Counters c = integrator->iterate({scene, camera, pool, 1, 0, never}, image);
    const double whole_rate = static_cast<double>(c.rays + c.shadow_rays) / (cpu_seconds() - start);
    if (static_cast<double>(c.rays + c.shadow_rays) != sent) {
      fmt::print(stderr, "bench_rays: recorded {} rays, path sent {}\n", sent,
                 c.rays + c.shadow_rays);
      return 1;
    }
    if (round == 0) continue;  // warms the caches
    bare.push_back(bare_rate);
    whole.push_back(whole_rate);
    ratio.push_back(whole_rate / bare_rate);
  }
  fmt::print(
      "rays {:.0f}, of them shadow {:.0f} %, bare {:.2f} Mray/s a CPU second, path {:.2f}, "
      "ratio {:.3f} (lowest {:.3f}, highest {:.3f})\n",
      sent, 100 * shadow / sent, median(bare) / 1e6, median(whole) / 1e6, median(ratio),
      *std::min_element(ratio.begin(), ratio.end()), *std::max_element(ratio.begin(), ratio.end()));
  return 0;
}
