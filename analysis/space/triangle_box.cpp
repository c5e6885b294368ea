#include "analysis/space/triangle_box.h"

namespace lacuna {

namespace {

constexpr double unlimited = 1e300;

/// Below this an axis constrains a dimension no more than the bounding box does: over 4096 cells it
/// contributes less than the slack.
constexpr double negligible = 1e-13;

double largest(Imath::V3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

TriangleBox::TriangleBox(const std::array<Imath::V3d, 3>& corners) : corners_(corners) {
  for (int a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({corners[0][a], corners[1][a], corners[2][a]});
    bounds_.low[a] = ceiling(low - 1 - slack);
    bounds_.high[a] = floored(high + slack) + 1;
  }
}

TriangleBox::Axes::Axes(const std::array<Imath::V3d, 3>& corners, const CellBox& bounds) {
  const Imath::V3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const double scale = largest(e1) * largest(e2);
  const Imath::V3d n = scale > 0 ? e1.cross(e2) / scale : Imath::V3d(0.0);
  // Lines along the normal's largest component have few cells each; without a normal, lines along
  // the longest side are few.
  const bool flat = largest(n) > slack;
  w = 0;
  for (int a = 1; a < 3; ++a)
    if (flat ? std::abs(n[a]) > std::abs(n[w]) : bounds.side(a) > bounds.side(w)) w = a;
  u = (w + 1) % 3;
  v = (w + 2) % 3;

  // lower <= coefficient * x + other * y <= upper, solved for x.
  const auto solved = [](double coefficient, double other, double low, double high) -> Axis2 {
    if (std::abs(coefficient) < negligible) return {0, 1, -unlimited, unlimited};
    if (coefficient < 0) return {-other, -1 / coefficient, -high, -low};
    return {other, 1 / coefficient, low, high};
  };
  const auto edge_axis = [&](std::size_t i, int a, int b) -> Axis2 {
    const Imath::V3d &from = corners[i], &to = corners[(i + 1) % 3], &apex = corners[(i + 2) % 3];
    double p = from[b] - to[b], q = to[a] - from[a];
    const double length = std::max(std::abs(p), std::abs(q));
    if (length > 0) {
      p /= length;
      q /= length;
    }
    const auto [low, high] = std::minmax({p * from[a] + q * from[b], p * apex[a] + q * apex[b]});
    return solved(p, q, low - std::max(p, 0.0) - std::max(q, 0.0) - slack,
                  high - std::min(p, 0.0) - std::min(q, 0.0) + slack);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    uv[i] = edge_axis(i, u, v);
    wu[i] = edge_axis(i, w, u);
    wv[i] = edge_axis(i, w, v);
  }

  double above = 0, below = 0;  // how far a cell reaches along the normal from its low corner
  for (int a = 0; a < 3; ++a) {
    above += std::max(n[a], 0.0);
    below += std::min(n[a], 0.0);
  }
  const double at = n.dot(corners[0]);
  const Axis2 plane = solved(n[w], 1, at - above - slack, at - below + slack);
  normal_u = plane.other * n[u];
  normal_v = plane.other * n[v];
  normal_inverse = plane.inverse;
  lower = plane.lower;
  upper = plane.upper;
}

}  // namespace lacuna
