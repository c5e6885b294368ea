// Rays per CPU second of an integrator, as a share of what a bare loop reaches that sends the same
// rays through Embree one by one, in the same order: what the ray caster itself was asked.
//
//   bench_rays SCENE.glb WIDTH HEIGHT MAX_DEPTH ROUNDS [path | light | bdpt | bdpt-uniform |
//   many_lights]

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string>

#include "analysis/space/memory_limit.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/integrators/integrator.h"
#include "renderer/scene/scene_shape.h"

namespace {

using namespace lacuna;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The bare loop: fills Embree's own structures and calls it, nothing else.
std::uint64_t send(RTCScene scene, std::span<const RecordedRay> rays) {
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

IntegratorSettings settings_of(const std::string& method, int max_depth) {
  const PathLengths whole{.max_depth = max_depth, .roulette_depth = max_depth};
  if (method == "light") return LightSettings{whole};
  if (method == "bdpt") return BdptSettings{whole};
  if (method == "bdpt-uniform") {
    return BdptSettings{whole, UniformSettings{{.roulette = 0}}};  // the same rays every time
  }
  if (method == "many_lights") return ManyLightsSettings{whole};
  if (method == "path") return PathSettings{whole};
  fmt::print(stderr, "bench_rays: no method {}\n", method);
  std::exit(2);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6 && argc != 7) {
    fmt::print(stderr,
               "usage: bench_rays SCENE.glb WIDTH HEIGHT MAX_DEPTH ROUNDS "
               "[path | light | bdpt | bdpt-uniform | many_lights]\n");
    return 2;
  }
  const V2i size(std::atoi(argv[2]), std::atoi(argv[3]));
  const int rounds = std::atoi(argv[5]);
  const std::string method = argc == 7 ? argv[6] : "path";

  const ThreadPool pool(0);
  const auto integrator = make_integrator(settings_of(method, std::atoi(argv[4])));
  const Scene scene(load_gltf(argv[1]), integrator->needs(), std::nullopt, pool);
  const CameraData& eye = scene.data().cameras.front();
  const Camera camera(eye, size.x, size.y);
  ArtefactStore store{{}};
  SpaceAnalysis space{{.triangles = [&] { return triangle_soup(scene.data()); },
                       .geometry = geometry_key(scene.data()),
                       .seeds = [&] { return domain_seeds(scene.data(), eye, false); },
                       .settings = {},
                       .byte_limit = [] { return no_memory_limit; }},
                      store,
                      pool};
  integrator->prepare({scene, pool, space, camera});
  const std::function<bool()> never = [] { return false; };
  std::vector<RecordedRay> recording;
  {
    const ThreadPool alone(1);
    Image image(size.x, size.y);
    scene.rays().record(&recording);
    integrator->iterate({scene, camera, alone, 1, 0, never}, image);
    scene.rays().record(nullptr);
  }
  const auto sent = static_cast<double>(recording.size());
  double shadow = 0;
  for (const RecordedRay& r : recording) shadow += r.shadow ? 1 : 0;

  constexpr std::size_t part = 4096;
  const std::size_t parts = (recording.size() + part - 1) / part;
  std::vector<double> bare, whole, ratio;
  std::vector<std::uint64_t> hits(parts);
  for (int round = 0; round <= rounds; ++round) {
    double start = cpu_seconds();
    pool.for_each(static_cast<int>(parts), [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      hits[k] =
          send(scene.rays().embree_scene(),
               std::span(recording).subspan(k * part, std::min(part, recording.size() - k * part)));
    });
    const double bare_rate = sent / (cpu_seconds() - start);
    Image image(size.x, size.y);
    start = cpu_seconds();
    const Counters c = integrator->iterate({scene, camera, pool, 1, 0, never}, image);
    const double whole_rate = static_cast<double>(c.rays + c.shadow_rays) / (cpu_seconds() - start);
    if (static_cast<double>(c.rays + c.shadow_rays) != sent) {
      fmt::print(stderr, "bench_rays: recorded {} rays, sent {}\n", sent, c.rays + c.shadow_rays);
      return 1;
    }
    if (round == 0) continue;  // warms the caches
    bare.push_back(bare_rate);
    whole.push_back(whole_rate);
    ratio.push_back(whole_rate / bare_rate);
  }
  fmt::print(
      "rays {:.0f}, of them shadow {:.0f} %, bare {:.2f} Mray/s a CPU second, {} {:.2f}, "
      "ratio {:.3f} (lowest {:.3f}, highest {:.3f})\n",
      sent, 100 * shadow / sent, median(bare) / 1e6, method, median(whole) / 1e6, median(ratio),
      *std::min_element(ratio.begin(), ratio.end()), *std::max_element(ratio.begin(), ratio.end()));
  return 0;
}
