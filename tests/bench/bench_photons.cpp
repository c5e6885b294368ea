// The hash grid against the k-d tree of points, as ratios within one run: to build, on one thread
// each, and to look up all points within a radius. Points lie on the walls of a box, as photons do;
// queries are points of the same walls.
//
//   bench_photons [POINTS]

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <vector>

#include "base/parallel/clock_seconds.h"
#include "renderer/path/point_grid.h"
#include "renderer/path/point_tree.h"

namespace {

using namespace lacuna;

std::vector<V3f> on_walls(std::size_t n, std::uint64_t seed) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<V3f> points;
  points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const V2f at = rng.next2();
    const auto wall = static_cast<int>(6 * rng.next());
    V3f x(at.x, at.y, wall < 3 ? 0.0F : 1.0F);
    std::swap(x[wall % 3], x.z);
    points.push_back(x);
  }
  return points;
}

double now() { return clock_seconds(CLOCK_PROCESS_CPUTIME_ID); }

template <class Work>
double seconds_of(Work&& work) {
  const double begin = now();
  work();
  return now() - begin;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t n = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  const std::vector<V3f> points = on_walls(n, 1);
  const std::vector<V3f> queries = on_walls(std::min<std::size_t>(n, 200'000), 2);
  const ThreadPool one(1);
  PointGrid grid;
  PointTree tree;
  grid.build(points, 0.01, one);  // an integrator keeps its memory, too
  tree.build(points);
  // Radii for so many photons on average.
  fmt::print("{:>8} {:>10} {:>12} {:>12} {:>8} {:>12} {:>12} {:>8}\n", "photons", "radius",
             "build tree", "build grid", "ratio", "query tree", "query grid", "ratio");
  for (const double photons : {0.5, 5.0, 50.0}) {
    const double radius = std::sqrt(6 * photons / (3.14159265 * static_cast<double>(n)));
    const double tree_build = seconds_of([&] { tree.build(points); });
    const double grid_build = seconds_of([&] { grid.build(points, radius, one); });
    std::uint64_t in_tree = 0, in_grid = 0;
    const auto radius2 = static_cast<float>(radius) * static_cast<float>(radius);
    const double tree_query = seconds_of([&] {
      std::array<PointTree::Found, 256> found;  // more than lie there
      for (const V3f& q : queries) in_tree += tree.nearest(q, radius2, found);
    });
    Rng rng(3, 0, 0, Rng::Purpose::test);
    const double grid_query = seconds_of([&] {
      for (const V3f& q : queries) {
        grid.for_each_within(q, static_cast<float>(radius), rng,
                             [&](std::uint32_t, float, float) { ++in_grid; });
      }
    });
    fmt::print("{:8.1f} {:10.2e} {:10.0f}ms {:10.0f}ms {:8.1f} {:10.0f}ns {:10.0f}ns {:8.1f}\n",
               static_cast<double>(in_grid) / static_cast<double>(queries.size()), radius,
               1e3 * tree_build, 1e3 * grid_build, tree_build / grid_build,
               1e9 * tree_query / static_cast<double>(queries.size()),
               1e9 * grid_query / static_cast<double>(queries.size()), tree_query / grid_query);
    if (in_tree > in_grid * 1.001 || in_grid > in_tree * 1.001) {
      fmt::print(stderr, "the tree finds {} photons, the grid {}\n", in_tree, in_grid);
      return 1;
    }
  }
}
