#pragma once

#include "renderer/path/eye_batch.h"
#include "renderer/path/merge.h"
#include "renderer/path/walk.h"
#include "tests/renderer/path/whole_path.h"

namespace lacuna::test {

/// Walks along given directions, with the densities of a guide.
class ScriptedWalk final : public Walk {
 public:
  struct Step {
    V3f w;
    bool delta;
  };
  struct Script {
    const Vertex* first = nullptr;  ///< of the walk
    std::vector<Step> steps = {};   ///< of its vertices 1, 2, ...
  };
  ScriptedWalk(const Scene& scene, const Guide& guide, const Script& script,
               const WalkLimits& limits, Counters& counters)
      : Walk(scene, guide, limits, counters),
        guide_(guide),
        script_(script),
        transport_(limits.transport) {}

 private:
  std::optional<BsdfSample> sample(const Vertex& v, Rng&) const override {
    const Step& step = script_.steps[static_cast<std::size_t>(&v - script_.first) - 1];
    BsdfSample s;
    s.wi = step.w;
    s.weight = Rgb(1, 1, 1);
    s.delta = step.delta;
    s.pdf = guide_.pdf(v, v.wp, step.w, transport_);
    return s;
  }

  const Guide& guide_;
  const Script& script_;
  Transport transport_;
};

/// Makes whole paths once more, vertex by vertex, by walks from either end.
class Remake {
 public:
  /// `guide`: whose densities the walks have.
  Remake(const Scene& scene, const Camera& camera, const WholePath& path, const SampleCounts& n,
         const Guide& guide)
      : scene_(scene),
        camera_(camera),
        path_(path),
        counts_(n),
        guide_(guide),
        eye_(path.edges()),
        light_(static_cast<std::size_t>(path.edges()) + 1) {}

  /// The weight of technique `i` of Oracle::weights(); nothing if the walks do not come to the same
  /// vertices again.
  std::optional<double> weight(int i) {
    const int k = path_.edges();
    return i > k ? merging(i - k) : joining(i);
  }

 private:
  /// Of merging at x_j.
  std::optional<double> merging(int j) {
    const int depth = path_.edges() - j;
    if (!walk_eye(depth, false) || !walk_light(j + 1)) return std::nullopt;
    const SurfaceEndpoint eye{eye_.vertex(0, depth), depth, Transport::radiance, guide_};
    return merge_weight(eye, photon(light_[static_cast<std::size_t>(j)], j), counts_);
  }

  /// Of strategy s.
  std::optional<double> joining(int s) {
    const int k = path_.edges();
    if (!walk_eye(s == 0 ? k : k - s, s == 0)) return std::nullopt;
    if (s == 0) {
      const Vertex& v = eye_.vertex(0, k);
      const auto e = emitter_at(scene_, v);
      return e ? std::optional(hit_weight(v, k, *e, counts_, guide_)) : std::nullopt;
    }
    if (s > 1 && !walk_light(s)) return std::nullopt;
    if (s == 1) return joined(EmitterEndpoint{path_.emitter, guide_}, s);
    return joined(SurfaceEndpoint{light_[static_cast<std::size_t>(s) - 1], s - 1,
                                  Transport::importance, guide_},
                  s);
  }

  template <class Light>
  double joined(const Light& light, int s) const {
    const int depth = path_.edges() - s;
    if (depth == 0) {
      const EyeEndpoint eye{camera_, camera_.position()};
      return lacuna::weight(eye, light, connect(eye, light), counts_);
    }
    const SurfaceEndpoint eye{eye_.vertex(0, depth), depth, Transport::radiance, guide_};
    return lacuna::weight(eye, light, connect(eye, light), counts_);
  }

  /// From x_i to x_{i + by}.
  V3f step(int i, int by) const {
    if (path_.emitter.infinite() && (i == 0 || i + by == 0)) {
      return by > 0 ? path_.towards_eye(0) : -path_.towards_eye(0);
    }
    return (path_.x(i + by) - path_.x(i)).normalized();
  }

  /// Walks `depth` edges from the eye; the last one to the emitter itself where it is to be `hit`.
  bool walk_eye(int depth, bool hit) {
    const int k = path_.edges();
    eye_.states.clear();
    if (depth == 0) return true;
    eye_script_.first = &eye_.vertex(0, 0);
    eye_script_.steps.clear();
    for (int j = 1; j < depth; ++j) {
      eye_script_.steps.push_back({step(k - j, -1), path_.node(k - j).delta});
    }
    eye_.start(camera_, rng_, {camera_.position(), step(k, -1)}, 0);
    int reached = 0;
    trace_paths(eye_.states, eye_script_, depth, Transport::radiance, eye_side(counts_), reached);
    if (reached != depth) return false;
    for (int j = 1; j <= depth - (hit ? 1 : 0); ++j) {
      if (!same(eye_.vertex(0, j), path_.node(k - j))) return false;
    }
    return true;
  }

  /// Walks to vertex s - 1 from the light, as LightBatch does.
  bool walk_light(int s) {
    const EmitterPoint& e = path_.emitter;
    light_script_.first = light_.data();
    light_script_.steps.clear();
    for (int j = 1; j < s - 1; ++j) {
      light_script_.steps.push_back({step(j, 1), path_.node(j).delta});
    }
    const V3f w = step(0, 1);
    V3f from = e.kind == EmitterPoint::Kind::area ? offset_origin(e.x, e.ng, e.offset, w) : e.x;
    if (e.infinite()) from = path_.x(1) - w * static_cast<float>(scene_.bounds().radius() * 2);
    light_[0].kind = e.infinite() ? Vertex::Kind::background : Vertex::Kind::emitter;
    light_[0].surface.x = e.x;
    light_[0].surface.ng = e.ng;
    PathState walker{.rng = rng_, .ray = {from, w}, .p = guide_.pdf_Le(e, w), .path = light_};
    if (!e.delta()) walker.mis_partial = counts_.hit / double(e.pdf.value);
    int reached = 0;
    trace_paths(std::span(&walker, 1), light_script_, s - 1, Transport::importance,
                light_side(counts_), reached);
    if (reached != s - 1) return false;
    for (int j = 1; j < s; ++j) {
      if (!same(light_[static_cast<std::size_t>(j)], path_.node(j))) return false;
    }
    return true;
  }

  void trace_paths(std::span<PathState> states, const ScriptedWalk::Script& script, int depth,
                   Transport transport, const TechniqueCounts& side, int& reached) {
    Counters counters;
    ScriptedWalk walk(scene_, guide_, script,
                      {.max_depth = depth,
                       .last_scatters = true,
                       .roulette_depth = depth + 1,
                       .transport = transport,
                       .counts = side},
                      counters);
    walk.trace_paths(states, [&](std::size_t, int d) { reached = d; });
  }

  /// The same triangle, and nearly the same place on it.
  bool same(const Vertex& v, const WholePath::Node& node) const {
    return v.kind == Vertex::Kind::surface && v.surface.mesh == node.surface.mesh &&
           v.surface.triangle == node.surface.triangle &&
           (v.surface.x - node.surface.x).length() <
               1e-4F * static_cast<float>(scene_.bounds().radius());
  }

  const Scene& scene_;
  const Camera& camera_;
  const WholePath& path_;
  SampleCounts counts_;
  const Guide& guide_;
  Rng rng_{1, 0, 0, Rng::Purpose::test};
  EyeBatch eye_;
  std::vector<Vertex> light_;
  ScriptedWalk::Script eye_script_, light_script_;
};

}  // namespace lacuna::test
