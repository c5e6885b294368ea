#pragma once

#include <array>

#include "renderer/mutations/chain_state.h"
#include "renderer/mutations/primary_samples.h"
#include "renderer/path/contexts.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/guide.h"
#include "renderer/path/light_batch.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// The strategies (s, t) to evaluate for a pair of paths: s and t within these bounds, and paths of
/// `least_edges` to `most_edges`.
struct WantedPaths {
  int least_s = 0, most_s = 0;
  int least_t = 1, most_t = 1;
  int least_edges = 1, most_edges = 1;
  float scale = 1;  ///< 1 / the probability of selecting these

  bool wants(int s, int t) const {
    const int edges = s + t - 1;
    return s >= least_s && s <= most_s && t >= least_t && t <= most_t && edges >= least_edges &&
           edges <= most_edges;
  }
};

/// Evaluates points of primary sample space: for each, an eye path and a light path, connected by
/// the wanted strategies of bidirectional path tracing. Traces a batch together. Not thread-safe.
class PathEvaluator {
 public:
  static constexpr std::size_t size = 16;

  PathEvaluator(const IterationContext& context, const PathLengths& lengths);
  PathEvaluator(const PathEvaluator&) = delete;
  PathEvaluator& operator=(const PathEvaluator&) = delete;

  /// A point: its streams, the strategies, and the destination of the result.
  struct Point {
    RandomWords* eye = nullptr;
    RandomWords* light = nullptr;
    WantedPaths wanted;
    ChainState* result = nullptr;
  };
  /// Fills the results of at most `size` points.
  void evaluate(std::span<const Point> points, Counters& counters);

 private:
  /// A contribution that a shadow ray must test.
  struct PendingContribution {
    Rgb value;
    std::size_t point;
    std::uint32_t pixel;  ///< unused for a splat
    std::uint16_t edges;
    PathMatches matches;
    bool splat = false;
    V2f at{0, 0};
  };

  void walk_lights(std::span<const Point> points, Counters& counters);
  void walk_eyes(std::span<const Point> points, Counters& counters);
  /// Evaluates the strategies at vertex `depth` of eye path `i`.
  void gather(const Point& point, std::size_t i, int depth);
  void add(const Point& point, std::uint32_t pixel, const Rgb& value, Counters& counters) const;
  /// Adds it to ChainState::parts, if they are wanted.
  void add_part(const Point& point, const ChainState::Part& part) const;

  const IterationContext& context_;
  SampleCounts counts_;
  LightPathSetting setting_;
  Guide guide_;
  EyeBatch eyes_;
  LightBatch lights_;
  std::vector<Rng> rngs_;
  std::vector<int> vertices_;                           // wanted length of each light path
  std::array<std::size_t, size> light_of_{};            // of each point: index of its light path
  std::array<std::size_t, EyeBatch::size> point_of_{};  // of each eye path: its point
  ShadowQueue<PendingContribution> queue_;
  SparseStop stop_;
};

}  // namespace lacuna
