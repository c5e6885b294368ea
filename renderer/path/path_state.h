#pragma once

#include <span>

#include "renderer/core/rng.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// What Russian roulette and splitting keep of a path.
struct RouletteState {
  /// BsdfSample::pdf_ratio of all vertices: throughput times this scale is the throughput that
  /// sampling the BSDF would have left. A guide lowers throughput where it sends many paths, so
  /// roulette by throughput alone would end just those.
  float scale = 1;
  /// The path's throughput times this is what roulette goes by. Of an eye path: the largest
  /// component of what PathReuse keeps apart from the throughput; of a light path: 1 / that of the
  /// first edge.
  float carried_before = 1;
  int reference = 0;  ///< depth of the first vertex whose BSDF has a density; 0: none yet
  /// Expected luminance that the path adds behind that vertex; below 0: not computed yet.
  float expected = -1;
  float least = 0;  ///< luminance of throughput below which the path is not split
  float split = 1;  ///< number of equal parts it was split into since it started or branched off
  /// The window has replaced roulette by throughput at the last vertex.
  bool windowed = false;
};

/// The state of a random walk between two edges.
struct PathState {
  Rng rng;
  Ray ray;                  ///< the next edge
  Rgb throughput{1, 1, 1};  ///< along `ray`
  Pdf<SolidAngle> p;        ///< density with which the direction of `ray` was sampled
  std::span<Vertex> path;   ///< room for max_depth + 1 vertices; path[0] is set
  /// mis_partial_sum() of the last vertex over its density. At vertex 0 of a light path whose
  /// emitter can be hit: TechniqueCounts::none over its density.
  double mis_partial = 0;
  int depth = 0;  ///< edges traced: path[depth] is the last vertex
  RouletteState roulette = {};
};

}  // namespace lacuna
