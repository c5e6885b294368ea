#include "renderer/emitters/light_node.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

/// Rounding errors of positions, relative to the largest coordinate.
constexpr double few_roundings = 0x1p-20;
/// Half a step of an 8-bit number, reduced so that the cone of a single axis is not widened.
constexpr double half_step = 0.499 / 127;
/// Margin of a reach, in its cosine: axes and angles are rounded to 8 bits.
constexpr double reach_margin = 0.02;
/// Lower bound of intensities relative to a node's largest; smaller ones are raised to it.
constexpr float least_intensity = 0x1p-100F;

/// A number in [-1, 1], times 127, rounded.
std::int8_t eight_bits(double v) {
  return static_cast<std::int8_t>(std::lround(127 * std::clamp(v, -1.0, 1.0)));
}

/// LightNode::r, rounded up from `v` >= 0.
std::uint16_t radius_above(double v) {
  auto f = static_cast<float>(v);
  if (double(f) < v) f = std::nextafter(f, std::numeric_limits<float>::max());
  constexpr std::uint32_t less = (1U << LightNode::radius_shift) - 1;
  const std::uint32_t bits = std::min(std::bit_cast<std::uint32_t>(f), 0x7f7fffffU - less);
  return static_cast<std::uint16_t>((bits + less) >> LightNode::radius_shift);
}

/// LightNode::intensity, rounded from `v` in (0, 1].
std::uint16_t intensity_near(double v) {
  const float f = std::max(static_cast<float>(v), least_intensity);
  constexpr std::uint32_t half = 1U << (LightNode::intensity_shift - 1);
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(f) + half) >>
                                    LightNode::intensity_shift);
}

double largest_coordinate(const Bounds& box) {
  double largest = 0;
  for (int a = 0; a < 3; ++a) {
    largest = std::max({largest, std::abs(box.low[a]), std::abs(box.high[a])});
  }
  return largest;
}

V3d centre_of(const EmitterBounds& b) { return (b.box.low + b.box.high) / 2; }

}  // namespace

LightNode::LightNode(std::span<const EmitterBounds> children)
    : count(static_cast<std::uint8_t>(children.size() & 15)) {
  double most = 0;
  Bounds centres;
  for (const EmitterBounds& c : children) {
    most = std::max(most, c.intensity);
    centres.add(V3f(centre_of(c)));
  }
  origin = V3f(centres.low);
  step = static_cast<float>(max_component(centres.size()) / 255);
  for (std::size_t k = 0; k < children.size(); ++k) {
    const EmitterBounds& c = children[k];
    V3d off(0, 0, 0);  // from the rounded centre
    for (int a = 0; a < 3; ++a) {
      const double along = centre_of(c)[a] - double(origin[a]);
      const double q = step > 0 ? std::clamp(std::round(along / double(step)), 0.0, 255.0) : 0.0;
      centre[static_cast<std::size_t>(a)][k] = static_cast<std::uint8_t>(q);
      off[a] = along - q * double(step);
    }
    r[k] = radius_above(c.box.radius() + off.length() + largest_coordinate(c.box) * few_roundings);
    intensity[k] = intensity_near(c.intensity / most);
    for (std::size_t a = 0; a < 3; ++a) {
      back[a][k] = eight_bits(-c.axes.axis[static_cast<int>(a)]);
    }
    // Round to a wider cone.
    cos_spread[k] = eight_bits(std::cos(c.axes.spread) - half_step);
    sin_spread[k] = eight_bits(std::sin(c.axes.spread) + half_step);
    cos_reach[k] = eight_bits(std::cos(c.reach) - reach_margin);
    if (cos_reach[k] > 0) spots = true;
    if (c.both_sides) both_sides = static_cast<std::uint8_t>(both_sides | 1U << k);
  }
}

}  // namespace lacuna
