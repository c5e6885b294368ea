#pragma once

#include "renderer/core/rng.h"
#include "renderer/mutations/path_measure.h"
#include "renderer/path/counters.h"

namespace lacuna {

/// Builds a path from both ends: vertices are appended to its part at the eye or to its part at the
/// light, and the two parts are joined. Functions that return false found no vertex; the path is
/// then abandoned.
class PathBuilder {
 public:
  /// The parts, kept from one path to the next for their memory.
  struct Parts {
    std::vector<PathNode> eye, light;  ///< from x_0 on; from x_k on, towards the eye
  };
  /// The vertices that a path newly has are taken from `pool`; all outlive the building.
  PathBuilder(const PathMeasure& measure, VertexPool& pool, Parts& parts, Counters& counters)
      : measure_(measure), pool_(pool), counters_(counters), eye_(parts.eye), light_(parts.light) {
    eye_.clear();
    light_.clear();
  }

  /// Begins with the nodes of `path` up to x_first and from x_last on; none of the light's if
  /// `last` is k + 1.
  void keep(const WholePath& path, int first, int last);
  /// Replaces what is kept of one part only: up to x_first, from x_last on. It was not appended to.
  void keep_eye(const WholePath& path, int first);
  void keep_light(const WholePath& path, int last);

  /// Appends `n` vertices sampled from the eye's end: the film is sampled uniformly, then BSDFs.
  bool sample_from_eye(int n, Rng& rng);
  /// Appends `n` vertices sampled from the light's end; the first of an empty end is a point on an
  /// emitter.
  bool sample_from_light(int n, Rng& rng);

  /// Appends the vertex that a ray through film position `at` meets. The eye's end is x_0.
  bool look_through(const V2f& at);
  /// Append the vertex that a ray from the end along unit `w` meets.
  bool go_from_eye(const V3f& w);
  bool go_from_light(const V3f& w);
  /// Appends the vertex that a ray along unit `w` through `at` meets, from outside the scene. The
  /// light's end is x_k, an emitter at infinity; `at` is beside a surface, across `w`.
  bool enter_scene(const V3f& at, const V3f& w);
  /// Append the vertex behind the delta lobe at the end.
  bool follow_from_eye(bool transmitted);
  bool follow_from_light(bool transmitted);

  /// Makes the end of the eye's part, a vertex that a ray met, the end of the path. False if it is
  /// on no emitter.
  bool end_on_emitter();

  const std::vector<PathNode>& eye() const { return eye_; }
  const std::vector<PathNode>& light() const { return light_; }
  const PathMeasure& measure() const { return measure_; }
  const VertexPool& pool() const { return pool_; }
  bool eye_on_surface() const { return vertex(eye_.back()).kind == Vertex::Kind::surface; }
  bool light_is_infinite() const { return vertex(light_.back()).kind == Vertex::Kind::background; }

  /// Joins the ends by a segment, if the light's is not empty, and writes the nodes to `path`.
  /// False where the eye's end left the scene.
  bool join(WholePath& path);
  /// The segment that joins both parts is unoccluded.
  bool visible() const;
  /// Gives back the vertices that were appended since keep().
  void abandon();

 private:
  const Vertex& vertex(const PathNode& n) const { return pool_[n.vertex].v; }
  bool arrive(const Ray& ray, std::vector<PathNode>& end);
  bool scatter(std::vector<PathNode>& end, Transport transport, Rng& rng);
  bool start_light(Rng& rng);
  bool leave_light(Rng& rng);

  const PathMeasure& measure_;
  VertexPool& pool_;
  Counters& counters_;
  std::vector<PathNode>&eye_, &light_;
  std::size_t kept_eye_ = 0, kept_light_ = 0;
};

}  // namespace lacuna
