#pragma once

#include <span>

#include "renderer/core/rng.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// The state of a path that Russian roulette and splitting need.
struct RouletteState {
  /// Product of BsdfSample::pdf_ratio over the vertices: throughput times `scale` is what sampling
  /// the BSDF would have given. A guide lowers the throughput of directions that it samples often,
  /// so roulette by the throughput alone would end just these paths.
  float scale = 1;
  /// Roulette uses throughput times this. Eye paths: the largest component of the factor that
  /// PathReuse has moved out of the throughput, or 1. Light paths: 1 over the largest component of
  /// the throughput of the first edge, which has the unit of power.
  float carried_before = 1;
  int reference = 0;  ///< depth of the first connectible vertex; 0: none yet
  /// Expected luminance of the contributions after that vertex; below 0: not computed yet.
  float expected = -1;
  float least = 0;  ///< luminance of throughput below which the path is not split
  float split = 1;  ///< number of equal parts it was split into since it started or branched off
  /// The window decided at the last vertex: survives() does not.
  bool windowed = false;
};

/// The state of a random walk between two edges.
struct PathState {
  Rng rng;
  Ray ray;                  ///< the next edge
  Rgb throughput{1, 1, 1};  ///< along `ray`
  Pdf<SolidAngle> p;        ///< density with which the direction of `ray` was sampled
  std::span<Vertex> path;   ///< room for max_depth + 1 vertices; path[0] is set
  /// mis_partial_sum() plus merge_partial() of the last vertex, over its density. At vertex 0 of a
  /// light path whose emitter can be hit: TechniqueCounts::none over its density.
  double mis_partial = 0;
  int depth = 0;  ///< edges traced: path[depth] is the last vertex
  RouletteState roulette = {};
};

}  // namespace lacuna
