#include "renderer/mutations/path_perturbation.h"

#include <cmath>

#include "renderer/core/frame.h"

namespace lacuna {
namespace {

/// Log-uniform in (largest 2^-octaves, largest].
double distance(double largest, double octaves, Rng& rng) {
  return largest * std::exp2(-octaves * rng.next_choice());
}

}  // namespace

V3f PathPerturbation::rotated(const V3f& w, Rng& rng) const {
  const auto angle = static_cast<float>(distance(settings_.largest_angle, settings_.octaves, rng));
  const float phi = 2 * pi * rng.next();
  const float s = std::sin(angle);
  return Frame(w).to_world({s * std::cos(phi), s * std::sin(phi), std::cos(angle)}).normalized();
}

V2f PathPerturbation::moved(const V2f& at, const PathBuilder& builder, Rng& rng) const {
  const double size = settings_.largest_lens * builder.measure().camera().height();
  const auto r = static_cast<float>(distance(size, settings_.octaves, rng));
  const float phi = 2 * pi * rng.next();
  return at + V2f(r * std::cos(phi), r * std::sin(phi));
}

double PathPerturbation::reach(const VertexPool& pool, const WholePath& path) const {
  int i = path.edge_count() - 1;
  double length = 0;
  do {
    const V3f& x = pool[path.node(i--).vertex].v.surface.x;
    length += double((pool[path.node(i).vertex].v.surface.x - x).length());
  } while (path.node(i).delta);
  return settings_.largest_angle * length;
}

bool PathPerturbation::shift_ray(const WholePath& path, PathBuilder& builder, Rng& rng) {
  shift_ = distance(reach(builder.pool(), path), settings_.octaves, rng);
  const auto r = static_cast<float>(shift_);
  const float phi = 2 * pi * rng.next();
  const V3f& w = path.edges.back().w;
  const V3f& x = builder.pool()[path.nodes.rbegin()[1].vertex].v.surface.x;
  return builder.enter_scene(x + Frame(w).to_world({r * std::cos(phi), r * std::sin(phi), 0}), -w);
}

bool PathPerturbation::propose_from_eye(const WholePath& path, int start, PathBuilder& builder,
                                        Rng& rng) {
  const int k = path.edge_count();
  from_eye_ = true;
  first_ = start + 1;
  if (path.node(start).delta) return false;
  builder.keep(path, start, k + 1);
  // Half of the moves of the film position also resample the point on the lens: the probability
  // is the same both ways.
  if (start == 0 && builder.measure().camera().has_lens() && rng.decide(0.5F)) {
    builder.choose_eye(rng);
  }
  for (int i = start + 1;; ++i) {
    const PathNode& before = path.node(i - 1);
    bool found = false;
    if (before.delta) {
      found = builder.follow_from_eye(before.transmitted);
    } else if (i == 1) {
      const V2f at = moved(path.film, builder, rng);
      found = builder.measure().on_film(at) && builder.look_through(at);
    } else {
      found = builder.go_from_eye(rotated(path.edge(i - 1).w, rng));
    }
    if (!found) return false;
    last_ = i;
    if (i == k) return builder.end_on_emitter();
    if (!builder.eye_on_surface()) return false;
    if (!path.node(i).delta && !path.node(i + 1).delta) {
      builder.keep_light(path, i + 1);
      return true;
    }
  }
}

bool PathPerturbation::propose_from_light(const WholePath& path, int start, PathBuilder& builder,
                                          Rng& rng) {
  from_eye_ = false;
  shift_ = 0;
  last_ = start - 1;
  if (path.node(start).delta || start == 1) return false;
  builder.keep(path, 0, start);
  for (int i = start - 1; i > 0; --i) {
    const PathNode& before = path.node(i + 1);
    bool found = false;
    if (before.delta) {
      found = builder.follow_from_light(before.transmitted);
    } else if (builder.light_is_infinite()) {
      found = shift_ray(path, builder, rng);
    } else {
      found = builder.go_from_light(rotated(-path.edge(i).w, rng));
    }
    if (!found) return false;
    first_ = i;
    if (!path.node(i).delta && !path.node(i - 1).delta) {
      builder.keep_eye(path, i - 1);
      return true;
    }
  }
  return false;
}

long double PathPerturbation::reverse_ratio(const PathMeasure& measure, const VertexPool& pool,
                                            const WholePath& from, const WholePath& to) const {
  if (shift_ > 0) {
    // The shift is log-uniform: its density is equal in both directions, if both are possible.
    const double octave = std::log2(reach(pool, to) / shift_);
    if (!(octave >= 0 && octave < settings_.octaves)) return 0;
  }
  long double ratio = 1;
  for (int i = first_; i <= last_; ++i) {
    if (from_eye_) {
      ratio *= measure.per_direction_from_eye(from, pool, i) /
               measure.per_direction_from_eye(to, pool, i);
    } else {
      ratio *= measure.per_direction_from_light(from, pool, i) /
               measure.per_direction_from_light(to, pool, i);
    }
  }
  return ratio;
}

}  // namespace lacuna
