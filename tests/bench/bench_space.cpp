// Seconds of the steps from triangles to regions, with one and with two threads.
//
//   bench_space [--scene=FILE.glb] [--grid=FILE.vox] [Google Benchmark's options]
//
// Grids: 512^3 random blobs; the thesis author's grid, if named (grids.h). Triangles: a million
// small ones and a large wall; the scene, if named.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>

#include "analysis/regions/borders.h"
#include "analysis/regions/forest_labels.h"
#include "analysis/regions/portals.h"
#include "analysis/space/components.h"
#include "analysis/space/distance.h"
#include "analysis/space/domain.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/opening.h"
#include "analysis/space/opening_query.h"
#include "analysis/space/voxelize.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/bench/grids.h"

namespace {

using namespace lacuna;
using bench::random_blobs;
using bench::read_grid;

TriangleSoup soup_of(const SceneData& scene) {
  TriangleSoup soup;
  for (const Mesh& mesh : scene.meshes) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const V3f& p : mesh.positions) soup.positions.emplace_back(p.x, p.y, p.z);
    for (const auto& t : mesh.triangles)
      soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return soup;
}

TriangleSoup small_triangles(int count) {
  TriangleSoup soup;
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(0, 1);
  for (int i = 0; i < count; ++i) {
    const Imath::V3f at(u(rng), u(rng), u(rng));
    for (std::uint32_t k = 0; k < 3; ++k)
      soup.positions.push_back(at + Imath::V3f(u(rng), u(rng), u(rng)) * 0.01F);
    const auto first = static_cast<std::uint32_t>(3 * i);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleSoup tilted_wall() {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0.1F}, {1, 0, 0.3F}, {1, 1, 0.8F}, {0, 1, 0.6F}, {0, 0, 0}, {1, 1, 1}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 4, 4}, {5, 5, 5}};
  return soup;
}

/// Registers `body(pool)` for one and for two threads; time is wall time, CPU that of all threads.
template <class Body>
void add(const std::string& name, Body body) {
  for (const int threads : {1, 2})
    benchmark::RegisterBenchmark(fmt::format("{}/threads:{}", name, threads).c_str(),
                                 [body, threads](benchmark::State& state) {
                                   const ThreadPool pool(threads);
                                   for (auto _ : state) body(pool);
                                 })
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
}

void add_soup(const std::string& name, TriangleSoup triangles, int resolution) {
  const auto soup = std::make_shared<TriangleSoup>(std::move(triangles));
  add(fmt::format("voxelize/{}/{}", name, resolution), [=](const ThreadPool& pool) {
    benchmark::DoNotOptimize(voxelize(*soup, resolution, pool, no_memory_limit).scene.data());
  });
}

void add_queries(const std::string& name, const std::shared_ptr<BitGrid3>& domain) {
  benchmark::RegisterBenchmark((name + "/omega_1 of a voxel").c_str(),
                               [domain](benchmark::State& state) {
                                 const ThreadPool pool(1);
                                 const auto l1 = l1_distance(*domain, pool, no_memory_limit);
                                 const OpeningQuery query(l1, pool);
                                 std::mt19937 rng(3);
                                 std::uniform_int_distribution<std::size_t> any(0, l1.count() - 1);
                                 for (auto _ : state) {
                                   std::size_t i = any(rng);
                                   while (l1[i] == 0) i = any(rng);
                                   benchmark::DoNotOptimize(query(l1.voxel(i)));
                                 }
                               })
      ->Unit(benchmark::kMicrosecond);
}

void add_grid(const std::string& name, BitGrid3 grid) {
  const auto domain = std::make_shared<BitGrid3>(std::move(grid));
  for (const Connectivity connectivity : {Connectivity::faces, Connectivity::corners})
    add(fmt::format("{}/components {}", name, connectivity == Connectivity::faces ? 6 : 26),
        [=](const ThreadPool& pool) {
          const Components c = connected_components(*domain, connectivity, pool, no_memory_limit);
          benchmark::DoNotOptimize(c.voxels.data());
        });
  add(name + "/l1", [=](const ThreadPool& pool) {
    benchmark::DoNotOptimize(l1_distance(*domain, pool, no_memory_limit).data());
  });
  add(name + "/chebyshev", [=](const ThreadPool& pool) {
    benchmark::DoNotOptimize(chebyshev_distance(*domain, pool, no_memory_limit).data());
  });
  add(name + "/squared", [=](const ThreadPool& pool) {
    benchmark::DoNotOptimize(squared_distance(*domain, pool, no_memory_limit).data());
  });
  add_queries(name, domain);
  // Each with all that it needs.
  const auto forest = [=](const ThreadPool& pool) {
    return opening_forest(chebyshev_distance(*domain, pool, no_memory_limit), pool,
                          no_memory_limit);
  };
  add(name + "/forest",
      [=](const ThreadPool& pool) { benchmark::DoNotOptimize(forest(pool).centre.data()); });
  add(name + "/labels", [=](const ThreadPool& pool) {
    benchmark::DoNotOptimize(forest_labels(forest(pool), pool).regions.data());
  });
  add(name + "/portals", [=](const ThreadPool& pool) {
    const RegionLabels labels = forest_labels(forest(pool), pool);
    benchmark::DoNotOptimize(find_portals(labels, pool, no_memory_limit).voxels.data());
  });
  add(name + "/borders", [=](const ThreadPool& pool) {
    const RegionLabels labels = forest_labels(forest(pool), pool);
    benchmark::DoNotOptimize(
        find_borders(labels, BorderFaces::all, pool, no_memory_limit).voxels.data());
  });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument.rfind("--scene=", 0) == 0) {
        const std::filesystem::path file = argument.substr(8);
        for (const int resolution : {64, 128, 256, 512})
          add_soup(file.parent_path().filename(), soup_of(load_gltf(file)), resolution);
      } else if (argument.rfind("--grid=", 0) == 0) {
        const std::filesystem::path file = argument.substr(7);
        add_grid(file.stem(), read_grid(file));
      } else {
        throw std::invalid_argument("unknown argument " + argument);
      }
    }
    add_soup("10^6 small triangles", small_triangles(1000000), 512);
    add_soup("tilted wall", tilted_wall(), 512);
    add_grid("blobs 512^3", random_blobs(512));
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_space: {}\n", e.what());
    return 1;
  }
}
