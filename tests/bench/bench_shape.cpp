// Seconds and memory from a grid's empty voxels to its skeleton and node map.
//
//   bench_shape (GRID | yardstick) [RUNS [THREADS]]
//
// GRID: a file of the thesis author's (grids.h), blobs:SIDE or pebbles:NUMBER_ALONG_A_SIDE. Prints
// one JSON object: seconds of each run and step, the yardstick's seconds beside each
// run (yardstick.h), and the most memory that the process held by the end of the first run.
// `yardstick`: prints the yardstick's seconds alone, as a list.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "analysis/complex/curvilinear.h"
#include "analysis/skeleton/build_graph.h"
#include "analysis/skeleton/node_map.h"
#include "analysis/space/distance.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/opening_query.h"
#include "base/storage/peak_memory.h"
#include "tests/bench/grids.h"
#include "tests/bench/yardstick.h"

namespace {

using namespace lacuna;

BitGrid3 grid_of(const std::string& name) {
  if (name.starts_with("blobs:")) return bench::random_blobs(std::stoi(name.substr(6)));
  if (name.starts_with("pebbles:")) return bench::pebbles(std::stoi(name.substr(8)));
  return bench::read_grid(name);
}

/// Seconds since it was last asked.
class Watch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct Seconds {
  std::vector<double> all, distance, thinning, graph, map;
};

void run(const BitGrid3& domain, const ThreadPool& pool, Seconds& seconds, std::string& result) {
  Watch whole, step;
  const auto l1 = l1_distance(domain, pool, no_memory_limit);
  const OpeningQuery opening(l1, pool);
  seconds.distance.push_back(step.lap());
  ThinningReport report;
  const SpaceMaps maps{l1, [&](Imath::V3i v, int r) { return opening.reaches(v, r); }};
  const CubicalComplex thin = curvilinear_skeleton(domain, maps, report, &pool);
  seconds.thinning.push_back(step.lap());
  const SkeletonGraph graph = build_graph(thin, l1, pool);
  seconds.graph.push_back(step.lap());
  const auto map = node_map(domain, graph, pool, no_memory_limit);
  seconds.map.push_back(step.lap());
  seconds.all.push_back(whole.lap());
  result = fmt::format(R"("nodes": {}, "edges": {}, "squares_pierced": {}, "layers": {})",
                       graph.nodes(), graph.edges(), report.squares_pierced, report.layers);
}

void print_yardstick(int runs, const ThreadPool& pool) {
  bench::Yardstick yardstick(bench::plane_bytes, bench::sweeps);
  yardstick.measure(pool);
  std::vector<double> seconds;
  seconds.reserve(static_cast<std::size_t>(runs));
  for (int i = 0; i < runs; ++i) seconds.push_back(yardstick.measure(pool));
  fmt::print("{}\n", seconds);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw std::invalid_argument("usage: bench_shape GRID [RUNS [THREADS]]");
    const int runs = argc > 2 ? std::stoi(argv[2]) : 1;
    const ThreadPool pool(argc > 3 ? std::stoi(argv[3]) : 0);
    if (std::string_view(argv[1]) == "yardstick") return print_yardstick(runs, pool), 0;
    const BitGrid3 domain = grid_of(argv[1]);
    Seconds s;
    std::string result;
    std::uint64_t peak = 0;
    std::vector<double> yardsticks;
    std::optional<bench::Yardstick> yardstick;
    for (int i = 0; i < runs; ++i) {
      if (i > 0) yardsticks.push_back(yardstick->measure(pool));
      run(domain, pool, s, result);
      if (i == 0) {
        peak = peak_memory();  // later runs also hold what the allocator kept of it
        yardstick.emplace(bench::plane_bytes, bench::sweeps);
        yardstick->measure(pool);
        yardsticks.push_back(yardstick->measure(pool));
      }
    }
    const Imath::V3i n = domain.size();
    fmt::print(
        R"({{"grid": [{}, {}, {}], "faces": {}, {}, "threads": {}, "peak_bytes": {}, "yardstick": {},)"
        "\n \"seconds\": {}, \"distance\": {}, \"thinning\": {}, \"graph\": {}, \"map\": {}}}\n",
        n.x, n.y, n.z, closure_faces(domain), result, pool.threads(), peak, yardsticks, s.all,
        s.distance, s.thinning, s.graph, s.map);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_shape: {}\n", e.what());
    return 1;
  }
}
