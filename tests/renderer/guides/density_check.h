#pragma once

#include "renderer/core/frame.h"
#include "renderer/core/rng.h"
#include "renderer/core/sampling.h"
#include "tests/statistics.h"

namespace lacuna::test {

/// What came of density_check().
struct DensityCheck {
  double p = 1;         ///< that draws differ so much from the density by chance
  double integral = 0;  ///< of the density over the sphere
  double integral_error = 0;
  double failed = 0;  ///< share of draws that gave nothing
};

/// Holds `draws` of `draw()`, which returns a unit direction or nothing, against `density(w)`, in
/// cells of equal area around `pole`. The density may jump anywhere and have needles: its integral
/// over a cell is sampled too, and what it lacks in precision counts as noise. Nine of ten
/// directions for that are uniform, the others drawn, so that no needle is missed and no term is
/// above 10; where the density is below ten times that of the uniform ones it is what is tested,
/// above, whether needles are where they should be.
template <class Draw, class Density>
DensityCheck density_check(const Draw& draw, const Density& density, int draws, Rng& rng,
                           const V3f& pole, int rings = 12) {
  const Frame frame(pole);
  const int sectors = 2 * rings;
  const auto cells = static_cast<std::size_t>(rings * sectors);
  const auto cell_of = [&](const V3f& w) {
    const V3f l = frame.to_local(w);
    const int ring = std::clamp(static_cast<int>((l.z + 1) / 2 * float(rings)), 0, rings - 1);
    const float phi = std::atan2(l.y, l.x) / (2 * pi) + 0.5F;
    const int sector = std::clamp(static_cast<int>(phi * float(sectors)), 0, sectors - 1);
    return static_cast<std::size_t>(ring * sectors + sector);
  };
  DensityCheck result;
  std::vector<double> observed(cells, 0.0), sum(cells, 0.0), square(cells, 0.0);
  for (int i = 0; i < draws; ++i) {
    if (const std::optional<V3f> w = draw()) {
      ++observed[cell_of(*w)];
    } else {
      result.failed += 1.0 / draws;
    }
  }
  constexpr double drawn = 0.1;
  constexpr double uniform = 1 / (4 * std::numbers::pi);
  const int n = 5 * draws;
  double all = 0, all_square = 0;
  for (int i = 0; i < n; ++i) {
    std::optional<V3f> w;
    if (rng.next() < float(drawn)) {
      w = draw();
      if (!w) continue;
    } else {
      const V2f u = rng.next2();
      const float z = 2 * u.x - 1, r = std::sqrt(std::max(0.0F, 1 - z * z));
      w = V3f(r * std::cos(2 * pi * u.y), r * std::sin(2 * pi * u.y), z);
    }
    const auto p = double(density(*w));
    const double term = p / (drawn * p + (1 - drawn) * uniform);
    const std::size_t cell = cell_of(*w);
    sum[cell] += term;
    square[cell] += term * term;
    all += term;
    all_square += term * term;
  }
  result.integral = all / n;
  result.integral_error = std::sqrt((all_square / n - result.integral * result.integral) / n);
  // Cells that expect little are pooled.
  double statistic = 0, pooled = 0, pooled_mass = 0, pooled_variance = 0;
  int degrees = 0;
  const auto add = [&](double count, double mass, double variance) {
    const double off = count - draws * mass;
    statistic += off * off / (draws * mass + double(draws) * draws * variance);
    ++degrees;
  };
  for (std::size_t c = 0; c < cells; ++c) {
    const double mass = sum[c] / n, variance = (square[c] / n - mass * mass) / n;
    if (draws * mass >= 10) {
      add(observed[c], mass, variance);
    } else {
      pooled += observed[c];
      pooled_mass += mass;
      pooled_variance += variance;
    }
  }
  if (pooled_mass * draws >= 5) {
    add(pooled, pooled_mass, pooled_variance);
  } else if (pooled > 20) {
    result.p = 0;  // where none are expected
    return result;
  }
  if (degrees > 0) result.p = chi_square_beyond(statistic, degrees);
  return result;
}

}  // namespace lacuna::test
