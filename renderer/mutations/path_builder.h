#pragma once

#include "renderer/core/rng.h"
#include "renderer/mutations/path_measure.h"
#include "renderer/path/counters.h"

namespace lacuna {

/// Builds a path from both ends: vertices are appended to the eye's part or to the light's part,
/// and the two parts are connected. Functions return false if they find no vertex; the path is then
/// abandoned.
class PathBuilder {
 public:
  /// The parts; reused for the memory.
  struct Parts {
    std::vector<PathNode> eye, light;  ///< from x_0; from x_k, towards the eye
  };
  /// New vertices of the path are taken from `pool`. All arguments must outlive this.
  PathBuilder(const PathMeasure& measure, VertexPool& pool, Parts& parts, Counters& counters)
      : measure_(measure), pool_(pool), counters_(counters), eye_(parts.eye), light_(parts.light) {
    eye_.clear();
    light_.clear();
  }

  /// Starts with the nodes of `path` up to x_first and from x_last; no nodes at the light if `last`
  /// is k + 1. In a parallel projection x_0 is that of x_1: alone it is not kept, but new.
  void keep(const WholePath& path, int first, int last);
  /// Replaces the kept nodes of one part: up to x_first, or from x_last. Nothing may have been
  /// appended to that part.
  void keep_eye(const WholePath& path, int first);
  void keep_light(const WholePath& path, int last);

  /// Makes x_0 a new point of the lens, uniformly distributed. Only x_0 may be in the eye's part.
  /// Without a lens it does nothing.
  void choose_eye(Rng& rng);
  /// Appends `n` vertices sampled from the eye's end: a uniform film position, then BSDFs.
  bool sample_from_eye(int n, Rng& rng);
  /// Appends `n` vertices sampled from the light's end; if the part is empty, the first is a point
  /// on an emitter.
  bool sample_from_light(int n, Rng& rng);

  /// Appends the vertex hit by the ray through film position `at`. The eye's end must be x_0.
  bool look_through(const V2f& at);
  /// Append the vertex hit by the ray from the end along unit `w`.
  bool go_from_eye(const V3f& w);
  bool go_from_light(const V3f& w);
  /// Appends the vertex hit by a ray along unit `w` through `at`, which starts outside the scene.
  /// The light's end must be x_k, an emitter at infinity; `at` lies beside a surface point,
  /// perpendicular to `w`.
  bool enter_scene(const V3f& at, const V3f& w);
  /// Append the vertex reached by the delta lobe at the end.
  bool follow_from_eye(bool transmitted);
  bool follow_from_light(bool transmitted);

  /// Makes the end of the eye's part, a vertex that a ray hit, the end of the path. Returns false
  /// if it is not on an emitter.
  bool end_on_emitter();

  const std::vector<PathNode>& eye() const { return eye_; }
  const std::vector<PathNode>& light() const { return light_; }
  const PathMeasure& measure() const { return measure_; }
  const VertexPool& pool() const { return pool_; }
  bool eye_on_surface() const { return vertex(eye_.back()).kind == Vertex::Kind::surface; }
  bool light_is_infinite() const { return vertex(light_.back()).kind == Vertex::Kind::background; }

  /// Connects the ends by a segment, unless the light's part is empty, and writes the nodes to
  /// `path`. Returns false if the eye's end left the scene.
  bool connect(WholePath& path);
  /// Whether the segment that connects both parts is unoccluded.
  bool visible() const;
  /// Returns the vertices appended since keep() to the pool.
  void abandon();

 private:
  const Vertex& vertex(const PathNode& n) const { return pool_[n.vertex].v; }
  void renew_eye(const V3f& x);
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
