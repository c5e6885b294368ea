#include "renderer/mutations/path_evaluator.h"

#include <algorithm>

namespace lacuna {
namespace {

constexpr std::size_t no_path = ~std::size_t{0};

/// A point on the film: the pixel, and the position in it at which the camera samples. In 53 bits,
/// so that small steps move within a pixel.
struct FilmPoint {
  V2i pixel;
  V2f u;
};
FilmPoint film_point(Rng& rng, const Camera& camera) {
  const auto place = [&](int size) {
    const double at = rng.next_choice() * size;
    const int pixel = std::min(static_cast<int>(at), size - 1);
    return std::pair(pixel, std::min(static_cast<float>(at - pixel), 0x1.fffffep-1F));
  };
  const auto [x, u] = place(camera.width());
  const auto [y, v] = place(camera.height());
  return {{x, y}, {u, v}};
}

}  // namespace

PathEvaluator::PathEvaluator(const IterationContext& context, const PathLengths& lengths)
    : context_(context),
      counts_{1, 1, 1, double(context.camera.width()) * context.camera.height()},
      setting_{context.scene, context.camera, lengths.max_depth,    lengths.roulette_depth,
               counts_,       false,          EmitterChoice::power, context.light.automaton()},
      eyes_(lengths.max_depth),
      lights_(setting_, guide_) {}

void PathEvaluator::evaluate(std::span<const Point> points, Counters& counters) {
  for (const Point& p : points) p.result->clear();
  walk_lights(points, counters);
  walk_eyes(points, counters);
  const auto arrived = [&](const PendingContribution& u) {
    const auto add_to = [&](std::uint32_t pixel, const Rgb& value) {
      add(points[u.point], pixel, value, counters);
      add_part(points[u.point], {pixel, u.edges, u.matches, value});
    };
    if (!u.splat) return add_to(u.pixel, u.value);
    context_.camera.splat(
        u.at, [&](std::uint32_t pixel, float share) { add_to(pixel, u.value * share); });
  };
  queue_.flush(context_.scene.rays(), counters, arrived, [&] { context_.check_stop(); });
  for (std::size_t i = 0; i < eyes_.states.size(); ++i) {
    const Point& point = points[point_of_[i]];
    add(point, eyes_.pixels[i], eyes_.radiance[i], counters);
  }
}

void PathEvaluator::add(const Point& point, std::uint32_t pixel, const Rgb& value,
                        Counters& counters) const {
  const Rgb scaled = value * point.wanted.scale;
  if (!is_finite(scaled)) [[unlikely]] {
    ++counters.rejected;
    return;
  }
  const double scalar = double(luminance(scaled));
  if (!(scalar > 0)) return;
  auto& pixels = point.result->pixels;
  if (!pixels.empty() && pixels.back().index == pixel) {
    pixels.back().value += scaled;
  } else {
    pixels.push_back({pixel, scaled});
  }
  point.result->scalar += scalar;
}

void PathEvaluator::add_part(const Point& point, const ChainState::Part& part) const {
  if (!context_.light) return;
  const Rgb scaled = part.value * point.wanted.scale;
  if (!is_finite(scaled) || !(luminance(scaled) > 0)) return;
  point.result->parts.push_back({part.index, part.edges, part.matches, scaled});
}

void PathEvaluator::walk_lights(std::span<const Point> points, Counters& counters) {
  rngs_.clear();
  vertices_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WantedPaths& wanted = points[i].wanted;
    light_of_[i] = wanted.most_s > 0 ? rngs_.size() : no_path;
    if (wanted.most_s == 0) continue;
    rngs_.emplace_back(*points[i].light);
    vertices_.push_back(wanted.most_s);
  }
  lights_.walk(rngs_, counters, {}, vertices_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (light_of_[i] == no_path) continue;
    for (int s = 1; s <= lights_.length(light_of_[i]); ++s) {
      if (!points[i].wanted.wants(s, 1)) continue;
      lights_.connect_to_eye(light_of_[i], s - 1, [&](const Ray& ray, const auto& splat) {
        queue_.add(ray, {splat.value * splat.weight, i, 0, static_cast<std::uint16_t>(s),
                         splat.matches, true, splat.at});
      });
    }
  }
}

void PathEvaluator::walk_eyes(std::span<const Point> points, Counters& counters) {
  eyes_.states.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WantedPaths& wanted = points[i].wanted;
    if (wanted.most_t < 2) continue;
    // A light path that is too short has no vertex to connect.
    const int light = light_of_[i] == no_path ? 0 : lights_.length(light_of_[i]);
    if (light < wanted.least_s) continue;
    Rng rng(*points[i].eye);
    const FilmPoint film = film_point(rng, context_.camera);
    const auto pixel = std::size_t(film.pixel.y) * std::size_t(context_.camera.width()) +
                       std::size_t(film.pixel.x);
    point_of_[eyes_.states.size()] = i;
    const Ray ray = context_.camera.sample(film.pixel, film.u, rng);
    eyes_.start(context_.camera, rng, ray, pixel);
  }
  counters.samples += eyes_.states.size();
  Walk walk(context_.scene, guide_,
            {.max_depth = setting_.max_depth,
             .roulette_depth = setting_.roulette_depth,
             .counts = eye_side(counts_),
             .letters = setting_.letters},
            counters);
  walk.trace_paths(eyes_.states, [&](std::size_t i, int depth) {
    stop_.check(context_);
    const Point& point = points[point_of_[i]];
    gather(point, i, depth);
    return depth + 1 < point.wanted.most_t;
  });
}

void PathEvaluator::gather(const Point& point, std::size_t i, int depth) {
  const Vertex& v = eyes_.vertex(i, depth);
  const int t = depth + 1;
  if (point.wanted.wants(0, t)) {
    if (const std::optional<EmitterPoint> e = emitter_at(context_.scene, v)) {
      const auto weight = static_cast<float>(hit_weight(v, depth, *e, counts_, guide_));
      const Rgb value = v.throughput * e->emission * weight;
      eyes_.radiance[i] += value;
      add_part(point, {eyes_.pixels[i], static_cast<std::uint16_t>(depth),
                       matches_at_hit(setting_.letters, v), value});
    }
  }
  const std::size_t light = light_of_[point_of_[i]];
  if (light == no_path || v.kind != Vertex::Kind::surface || depth >= setting_.max_depth ||
      !v.bsdf->connectible()) {
    return;
  }
  const SurfaceEndpoint eye{v, depth, Transport::radiance, guide_};
  const auto connect_to = [&](const auto& end) {
    const Connection c = connect(eye, end);
    if (!c) return;
    const auto w = static_cast<float>(weight(eye, end, c, counts_));
    queue_.add(shadow_ray(eye, end, c), {c.contribution * w, point_of_[i], eyes_.pixels[i],
                                         static_cast<std::uint16_t>(end.index + t),
                                         matches_between(setting_.letters, eye, end, c.w)});
  };
  for (int s = 1; s <= lights_.length(light); ++s) {
    if (!point.wanted.wants(s, t)) continue;
    if (s == 1) {
      connect_to(EmitterEndpoint{lights_.emitter(light), guide_});
    } else if (lights_.connectible(light, s - 1)) {
      connect_to(lights_.end(light, s - 1));
    }
  }
}

}  // namespace lacuna
