// Which nodes of the skeleton have distributions (Noel 2015, 11.4), and that each distribution at a
// node (11.2) and at a record (11.5) is the one that its name says.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "renderer/connections/hybrid_connections.h"
#include "renderer/connections/node_weights.h"
#include "tests/renderer/connections/lit_scene.h"
#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::Lit;
using test::LitScene;
using test::PathScene;

/// A scene, its empty space and its light vertices.
struct ConnectedScene {
  explicit ConnectedScene(const char* name)
      : space(PathScene{name}, 16, 2), vertices(PathScene{name}) {}

  IterationContext context() const { return space.context(7); }
  const LightVertices& lights() const { return vertices.lights; }
  LightRange range() const { return {lights(), lights().longest()}; }
  /// Of walks of light, on surfaces all over the scene.
  std::vector<const Vertex*> surface_vertices() const {
    std::vector<const Vertex*> all;
    for (const auto& path : vertices.walked) {
      for (const Vertex& v : path) all.push_back(&v);
    }
    return all;
  }

  LitScene space;
  Lit vertices;
};

/// Statistics of earlier iterations, in each of which `visits[cell]` eye vertices were in a cell.
CellStatistics after(const std::vector<std::vector<int>>& iterations) {
  CellStatistics statistics;
  statistics.resize(iterations.front().size());
  for (const std::vector<int>& visits : iterations) {
    CellStatistics::Accumulator visited(visits.size());
    for (std::uint32_t cell = 0; cell < visits.size(); ++cell) {
      for (int k = 0; k < visits[cell]; ++k) visited.visit(cell);
    }
    visited.close();
    statistics.add({&visited, 1});
  }
  return statistics;
}
CellStatistics after_one_visit_each(std::size_t cells) {
  return after({std::vector<int>(cells, 1)});
}

/// Where a distribution stands among the `names`.
template <std::size_t n>
std::size_t place(const std::array<std::string_view, n>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument("no distribution " + std::string(name));
  return static_cast<std::size_t>(found - names.begin());
}

/// What the named distributions make together. Those that are not there weigh nothing.
template <std::size_t n>
ResamplingTable combined(const std::array<std::string_view, n>& names,
                         const std::map<std::string_view, std::vector<double>>& weights,
                         Combination combination) {
  std::vector<std::vector<double>> all(n, std::vector<double>(weights.begin()->second.size(), 0.0));
  for (const auto& [name, w] : weights) all[place(names, name)] = w;
  const std::vector<std::span<const double>> spans(all.begin(), all.end());
  return {spans, combination};
}

/// N_mapped >= alpha times its mean over all nodes, and not 0.
void expect_accepted(ConnectedScene& scene, double alpha,
                     const std::vector<std::vector<int>>& iterations, std::set<bool>& both) {
  SkeletonConnections connections([&] {
    SkeletonConnectionsSettings s;
    s.acceptance = alpha;
    return s;
  }());
  connections.prepare(scene.space.prepare_context());
  const std::size_t nodes = scene.space.space().filtered().graph.nodes();
  ASSERT_EQ(connections.cells(), nodes + 1);
  std::vector<double> mapped(nodes);
  double mean = 0;
  for (const std::vector<int>& visits : iterations) {
    for (std::size_t n = 0; n < nodes; ++n) {
      mapped[n] += visits[n];
      mean += double(visits[n]) / static_cast<double>(nodes);
    }
  }
  const auto accepted = [&](std::size_t n) {
    return mapped[n] > 0 && mapped[n] - alpha * mean > -1e-9;
  };
  Counters counters;
  connections.begin(scene.context(), scene.lights(), after(iterations), counters);
  double used = 0;
  for (std::size_t n = 0; n < nodes; ++n) used += accepted(n) ? 1 : 0;
  EXPECT_EQ(connections.statistics().at(1), std::pair(std::string("nodes_used"), used));
  Rng rng(31, 0, 0, Rng::Purpose::test);
  for (const Vertex* v : scene.surface_vertices()) {
    const auto lookup = connections.find(*v, 2, rng);
    const bool has = lookup.cell < nodes && accepted(lookup.cell);
    ASSERT_EQ(lookup.distributions != nullptr, has)
        << "node " << lookup.cell << ", visited " << (lookup.cell < nodes ? mapped[lookup.cell] : 0)
        << ", mean " << mean << ", acceptance " << alpha;
    both.insert(has);
    connections.sample(
        lookup, scene.range(), rng, [](int) { return 1.0F; },
        [&](int s, const VertexSample& drawn) {
          const bool fallback =
              SkeletonConnections::distributions.at(drawn.distribution) == "fallback";
          ASSERT_EQ(fallback, !has);
          if (fallback) {
            EXPECT_FLOAT_EQ(drawn.probability, 1 / float(scene.lights().count(s)));
          }
        });
  }
}

TEST(SkeletonConnections, AcceptNodesThatEnoughEyeVerticesBelongedTo) {
  for (const char* name : {"ajar", "bends"}) {
    SCOPED_TRACE(name);
    ConnectedScene scene(name);
    const std::size_t nodes = scene.space.space().filtered().graph.nodes();
    ASSERT_GT(nodes, 3U);
    Rng rng(32, 0, 0, Rng::Purpose::test);
    const auto random = [&] {
      std::vector<int> visits(nodes + 1);
      for (int& n : visits) n = rng.next() < 0.3F ? 0 : static_cast<int>(rng.below(20));
      visits.back() = 1000;  // of no node: not part of the mean
      return visits;
    };
    std::vector<int> alternating(nodes + 1, 3);
    for (std::size_t n = 0; n < nodes; n += 2) alternating[n] = 1;
    const std::vector<int> same(nodes + 1, 5), none(nodes + 1, 0);
    std::set<bool> both;
    for (const double alpha : {0.0, 0.25, 1.0, 1.5}) {
      expect_accepted(scene, alpha, {same}, both);  // each as many as the mean
      expect_accepted(scene, alpha, {same, none, same}, both);
      expect_accepted(scene, alpha, {alternating}, both);
      expect_accepted(scene, alpha, {random(), random(), random()}, both);
      expect_accepted(scene, alpha, {none}, both);
    }
    EXPECT_EQ(both.size(), 2U);
  }
}

/// The distributions at `x`, the position of a node: V and U as the settings have them, and C.
std::map<std::string_view, std::vector<double>> at_node(const ConnectedScene& scene,
                                                        const SkeletonConnectionsSettings& settings,
                                                        const V3f& x, double least_distance,
                                                        int s) {
  std::map<std::string_view, std::vector<double>> weights;
  weights["uniform"].assign(scene.lights().count(s), 1.0);
  const auto w = node_weights(scene.lights(), s, x, least_distance, settings.sides);
  if (settings.unshadowed) weights["unshadowed"] = w;
  if (settings.visible) {
    weights["visible"] = w;
    const std::vector<Ray> rays = rays_to(scene.lights(), s, x);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (scene.space.scene().rays().occluded(rays[i])) weights["visible"][i] = 0;
    }
  }
  return weights;
}

TEST(SkeletonConnections, HaveTheDistributionsOfTheirNames) {
  using Names = std::map<std::string_view, int>;
  Names all;
  for (const char* name : {"ajar", "bends", "atrium"}) {
    SCOPED_TRACE(name);
    ConnectedScene scene(name);
    const GridTransform grid = scene.space.space().voxels().transform;
    const SkeletonGraph& graph = scene.space.space().filtered().graph;
    for (const auto& [visible, unshadowed, combination, sides] :
         {std::tuple(true, true, Combination::mixture, LightSides::facing),
          std::tuple(true, true, Combination::max, LightSides::both),
          std::tuple(true, false, Combination::mixture, LightSides::both),
          std::tuple(false, true, Combination::mixture, LightSides::facing),
          std::tuple(false, false, Combination::max, LightSides::facing)}) {
      SkeletonConnectionsSettings settings;
      settings.acceptance = 0;
      settings.visible = visible;
      settings.unshadowed = unshadowed;
      settings.combination = combination;
      settings.sides = sides;
      SkeletonConnections connections(settings);
      connections.prepare(scene.space.prepare_context());
      Counters counters;
      connections.begin(scene.context(), scene.lights(), after_one_visit_each(connections.cells()),
                        counters);
      Rng rng(33, 0, 0, Rng::Purpose::test);
      std::map<std::uint32_t, std::vector<ResamplingTable>> of_node;
      Names names;
      for (const Vertex* v : scene.surface_vertices()) {
        const auto lookup = connections.find(*v, 2, rng);
        if (lookup.distributions == nullptr) continue;
        auto& tables = of_node[lookup.cell];
        for (int s = static_cast<int>(tables.size()) + 1; s <= scene.lights().longest(); ++s) {
          const V3f x(grid.to_world(V3d(graph.corners[lookup.cell])));
          const auto weights = at_node(scene, settings, x, grid.voxel_size / 2, s);
          tables.push_back(combined(SkeletonConnections::distributions, weights, combination));
        }
        connections.sample(
            lookup, scene.range(), rng, [](int) { return 1.0F; },
            [&](int s, const VertexSample& drawn) {
              const ResamplingTable& expected = tables[static_cast<std::size_t>(s) - 1];
              const float p = expected.pmf(drawn.index).value;
              EXPECT_NEAR(drawn.probability, p, 1e-6F * p);
              EXPECT_EQ(drawn.distribution, expected.distribution(drawn.index));
              ++names[SkeletonConnections::distributions.at(drawn.distribution)];
            });
      }
      EXPECT_GT(of_node.size(), 2U);
      EXPECT_EQ(names.contains("visible"), visible);
      EXPECT_EQ(names.contains("unshadowed"), unshadowed);
      EXPECT_TRUE(names.contains("uniform"));
      EXPECT_FALSE(names.contains("fallback"));
      for (const auto& [drawn, count] : names) all[drawn] += count;
    }
  }
  for (const auto& [name, count] : all) EXPECT_GT(count, 100) << name;
}

/// What the light vertices with `s` vertices give to a record: F, U and B as the settings have
/// them, and C.
std::map<std::string_view, std::vector<double>> at_record(const ConnectedScene& scene,
                                                          const ImportanceCacheSettings& settings,
                                                          const EyeRecords::Record& record, int s) {
  const RecordContributions c =
      contributions_to(record, scene.context(), scene.lights(), s,
                       {.full = true, .unshadowed = true, .bounded = true});
  std::map<std::string_view, std::vector<double>> weights;
  weights["uniform"].assign(scene.lights().count(s), 1.0);
  if (settings.full) weights["full"] = c.full;
  if (settings.unshadowed) weights["unshadowed"] = c.unshadowed;
  if (settings.bounded) weights["bounded"] = c.bounded;
  return weights;
}

/// Holds what is sampled for the vertices of the records against the distributions at the nearest.
void expect_records(const ConnectedScene& scene, const ImportanceCacheSettings& settings,
                    std::map<std::string_view, int>& names) {
  ImportanceCacheConnections connections(settings);
  EyeRecords records;
  Counters counters;
  records.place(scene.context(), scene.lights(), settings.record_density,
                std::numeric_limits<int>::max(), counters);
  connections.begin(scene.context(), scene.lights(), CellStatistics{}, counters);
  const int longest = scene.lights().longest();
  std::map<std::uint32_t, std::vector<ResamplingTable>> tables;
  Rng rng(34, 0, 0, Rng::Purpose::test);
  const auto neighbours = static_cast<std::size_t>(settings.neighbours);
  ASSERT_GT(records.size(), 2 * neighbours);
  for (std::size_t r = 0; r < records.size(); r += 2) {
    const auto lookup = connections.find(records[r].vertex, 1, rng);
    const EyeRecords::Neighbours nearest = records.nearest(records[r].vertex, settings.neighbours);
    ASSERT_EQ(nearest.n, neighbours);
    for (std::size_t k = 0; k < nearest.n; ++k) {
      auto& of_record = tables[nearest.index[k]];
      for (int s = static_cast<int>(of_record.size()) + 1; s <= longest; ++s) {
        of_record.push_back(combined(ImportanceCacheConnections::distributions,
                                     at_record(scene, settings, records[nearest.index[k]], s),
                                     settings.combination));
      }
    }
    for (int repeat = 0; repeat < 20; ++repeat) {
      connections.sample(
          lookup, scene.range(), rng, [](int) { return 1.0F; },
          [&](int s, const VertexSample& drawn) {
            double p = 0;
            bool is_owned = false;  // by that distribution, at one of the records
            for (std::size_t k = 0; k < nearest.n; ++k) {
              const ResamplingTable& t = tables[nearest.index[k]][static_cast<std::size_t>(s) - 1];
              p += double(t.pmf(drawn.index).value) / static_cast<double>(nearest.n);
              is_owned = is_owned || drawn.distribution == t.distribution(drawn.index);
            }
            EXPECT_NEAR(drawn.probability, p, 1e-6 * p);
            EXPECT_TRUE(is_owned) << int(drawn.distribution);
            ++names[ImportanceCacheConnections::distributions.at(drawn.distribution)];
          });
    }
  }
}

TEST(ImportanceCache, HasTheDistributionsOfTheirNames) {
  std::map<std::string_view, int> all;
  for (const char* name : {"ajar", "coated"}) {
    const ConnectedScene scene(name);
    for (int flags = 0; flags < 8; ++flags) {
      for (const Combination combination : {Combination::mixture, Combination::max}) {
        ImportanceCacheSettings settings;
        settings.full = flags % 2 != 0;
        settings.unshadowed = flags / 2 % 2 != 0;
        settings.bounded = flags / 4 != 0;
        settings.combination = combination;
        settings.neighbours = combination == Combination::max ? 1 : 3;
        settings.record_density = 0.005;
        SCOPED_TRACE(testing::Message() << name << ", full " << settings.full << ", unshadowed "
                                        << settings.unshadowed << ", bounded " << settings.bounded);
        std::map<std::string_view, int> names;
        expect_records(scene, settings, names);
        EXPECT_TRUE(settings.full || !names.contains("full"));
        EXPECT_TRUE(settings.unshadowed || !names.contains("unshadowed"));
        EXPECT_TRUE(settings.bounded || !names.contains("bounded"));
        for (const auto& [drawn, count] : names) all[drawn] += count;
      }
    }
  }
  EXPECT_EQ(all.size(), ImportanceCacheConnections::distributions.size());
  for (const auto& [name, count] : all) EXPECT_GT(count, 100) << name;
}

struct Drawn {
  int s;
  VertexSample sample;
  std::string_view name;
};
/// What is sampled for a vertex with the random numbers `rng`.
template <class Connections>
std::vector<Drawn> draws_of(const Connections& connections, const Vertex& v, int depth,
                            const LightRange& range, Rng rng) {
  std::vector<Drawn> all;
  connections.sample(
      connections.find(v, depth, rng), range, rng, [](int) { return 1.0F; },
      [&](int s, const VertexSample& d) {
        all.push_back({s, d, Connections::distributions.at(d.distribution)});
      });
  return all;
}

// Records at the first vertices, nodes behind them, with the same samples as either has alone.
TEST(HybridConnections, AreTheCacheAndTheSkeleton) {
  ConnectedScene scene("ajar");
  HybridSettings settings;
  settings.cached_depth = 2;
  settings.record_density = 0.02;
  settings.acceptance = 0;
  settings.combination = Combination::max;
  HybridConnections hybrid(settings);
  ImportanceCacheConnections cache(settings.cache(), settings.cached_depth);
  SkeletonConnections skeleton(settings.skeleton());
  hybrid.prepare(scene.space.prepare_context());
  skeleton.prepare(scene.space.prepare_context());
  Counters counters;
  const CellStatistics visited = after_one_visit_each(hybrid.cells());
  hybrid.begin(scene.context(), scene.lights(), visited, counters);
  cache.begin(scene.context(), scene.lights(), visited, counters);
  skeleton.begin(scene.context(), scene.lights(), visited, counters);
  std::set<std::string> names;
  std::uint64_t k = 0;
  for (const Vertex* v : scene.surface_vertices()) {
    for (const int depth : {1, 2, 3, 4}) {
      const Rng rng(35, 0, ++k, Rng::Purpose::test);
      const auto found = draws_of(hybrid, *v, depth, scene.range(), rng);
      const auto expected = depth <= 2 ? draws_of(cache, *v, depth, scene.range(), rng)
                                       : draws_of(skeleton, *v, depth, scene.range(), rng);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].s, expected[i].s);
        EXPECT_EQ(found[i].sample.index, expected[i].sample.index);
        EXPECT_EQ(found[i].sample.probability, expected[i].sample.probability);
        const std::string name = (depth <= 2 ? "cache_" : "") + std::string(expected[i].name);
        EXPECT_EQ(found[i].name, name);
        names.insert(name);
      }
    }
  }
  EXPECT_GE(names.size(), 5U);
}

}  // namespace
}  // namespace lacuna
