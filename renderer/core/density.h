#pragma once

namespace lacuna {

// Measures. A density carries its measure in its type; densities of different measures can be
// neither added nor compared, and only renderer/path/vertex.h converts between them.
struct Area;        ///< scene units^-2
struct SolidAngle;  ///< sr^-1
struct Count;       ///< a probability

/// A probability density in measure `M`. A plain float once the measure has been checked.
template <class M>
struct Pdf {
  float value = 0.0F;

  constexpr Pdf() = default;
  constexpr explicit Pdf(float v) : value(v) {}

  constexpr Pdf& operator+=(Pdf b) {
    value += b.value;
    return *this;
  }
  friend constexpr Pdf operator+(Pdf a, Pdf b) { return Pdf(a.value + b.value); }
  friend constexpr Pdf operator*(float s, Pdf a) { return Pdf(s * a.value); }
  /// Choosing a technique with probability `p` scales its density and keeps its measure.
  friend constexpr Pdf operator*(Pdf<Count> p, Pdf a) requires(!__is_same(M, Count)) {
    return Pdf(p.value * a.value);
  }
  /// Ratios of densities of one measure are plain numbers: what MIS is made of.
  friend constexpr float operator/(Pdf a, Pdf b) { return a.value / b.value; }
  constexpr bool positive() const { return value > 0.0F; }
};

}  // namespace lacuna
