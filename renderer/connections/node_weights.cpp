#include "renderer/connections/node_weights.h"

namespace lacuna {

namespace {

double over_distance(double power, const V3f& edge, double least_distance) {
  const double d2 = V3d(edge).length2();
  return power / std::max(d2, least_distance * least_distance);
}

double weight_of(const EmitterPoint& e, const V3f& x, double least_distance, LightSides sides) {
  const V3f edge = x - e.x;
  Rgb emitted = e.emission;
  if (sides == LightSides::facing && !e.infinite()) emitted = e.towards(edge.normalized());
  const double power = double(luminance(emitted)) / double(e.pdf.value);
  return e.infinite() ? power : over_distance(power, edge, least_distance);
}

double weight_of(const Vertex& y, const V3f& x, double least_distance, LightSides sides) {
  const V3f edge = x - y.surface.x;
  if (sides == LightSides::facing && !y.bsdf->transmits()) {
    const bool same = (dot(edge, y.surface.ng) > 0) == (dot(y.wp, y.surface.ng) > 0);
    if (!same) return 0;
  }
  return over_distance(double(luminance(y.throughput)), edge, least_distance);
}

}  // namespace

std::vector<double> node_weights(const LightVertices& lights, int s, const V3f& x,
                                 double least_distance, LightSides sides) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < lights.count(s); ++i) {
    const double w = s == 1 ? weight_of(lights.emitter(i), x, least_distance, sides)
                            : weight_of(lights.at(s, i), x, least_distance, sides);
    weights.push_back(std::isfinite(w) ? w : 0);
  }
  return weights;
}

Ray ray_to(const LightVertices& lights, int s, std::size_t i, const V3f& x) {
  const auto to = [&](const V3f& y, const auto& end_along) {
    const V3f edge = x - y;
    const float distance = edge.length();
    return Ray{x, end_along(edge / distance, distance) - x, 1.0F};
  };
  if (s > 1) {
    const Surface& y = lights.at(s, i).surface;
    return to(y.x, [&](const V3f& w, float distance) {
      return offset_end(y.x, y.ng, y.offset, w, distance);
    });
  }
  const EmitterPoint& e = lights.emitter(i);
  if (e.infinite()) return {x, e.x};
  return to(e.x, [&](const V3f& w, float distance) { return e.end(w, distance); });
}

std::vector<Ray> rays_to(const LightVertices& lights, int s, const V3f& x) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < lights.count(s); ++i) rays.push_back(ray_to(lights, s, i, x));
  return rays;
}

}  // namespace lacuna
