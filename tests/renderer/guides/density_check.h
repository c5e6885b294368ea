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
/// cells of equal area. The density may jump anywhere: its integral over a cell is itself sampled,
/// stratified, and what it lacks in precision counts as noise. Cells of `rings` x 2 `rings`; each
/// with `strata`^2 pairs of points.
template <class Draw, class Density>
DensityCheck density_check(const Draw& draw, const Density& density, int draws, Rng& rng,
                           const V3f& pole, int rings = 12, int strata = 12) {
  const Frame frame(pole);
  const int sectors = 2 * rings;
  const auto cells = static_cast<std::size_t>(rings * sectors);
  std::vector<double> observed(cells, 0.0), mass(cells, 0.0), variance(cells, 0.0);
  DensityCheck result;
  for (int i = 0; i < draws; ++i) {
    const std::optional<V3f> w = draw();
    if (!w) {
      result.failed += 1.0 / draws;
      continue;
    }
    const V3f l = frame.to_local(*w);
    const int ring = std::clamp(static_cast<int>((l.z + 1) / 2 * float(rings)), 0, rings - 1);
    const float phi = std::atan2(l.y, l.x) / (2 * pi) + 0.5F;
    const int sector = std::clamp(static_cast<int>(phi * float(sectors)), 0, sectors - 1);
    ++observed[static_cast<std::size_t>(ring * sectors + sector)];
  }
  const double stratum = 4 * std::numbers::pi / double(cells) / (strata * strata);
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const auto cell = static_cast<std::size_t>(ring * sectors + sector);
      for (int k = 0; k < strata * strata; ++k) {
        std::array<double, 2> values{};
        for (double& value : values) {
          const float a = (float(k % strata) + rng.next()) / float(strata);
          const float b = (float(k / strata) + rng.next()) / float(strata);
          const float z = 2 * (float(ring) + a) / float(rings) - 1;
          const float phi = ((float(sector) + b) / float(sectors) - 0.5F) * 2 * pi;
          const float r = std::sqrt(std::max(0.0F, 1 - z * z));
          value = double(density(frame.to_world({r * std::cos(phi), r * std::sin(phi), z})));
        }
        mass[cell] += (values[0] + values[1]) / 2 * stratum;
        const double half = (values[0] - values[1]) / 2 * stratum;
        variance[cell] += half * half;
      }
      result.integral += mass[cell];
      result.integral_error += variance[cell];
    }
  }
  result.integral_error = std::sqrt(result.integral_error);
  // Cells that expect little are pooled; the draws that failed are a cell of their own.
  double statistic = 0, pooled = 0, pooled_mass = 0, pooled_variance = 0;
  int degrees = 0;
  const auto add = [&](double n, double m, double v) {
    statistic += (n - draws * m) * (n - draws * m) / (draws * m + double(draws) * draws * v);
    ++degrees;
  };
  for (std::size_t c = 0; c < cells; ++c) {
    if (draws * mass[c] >= 10) {
      add(observed[c], mass[c], variance[c]);
    } else {
      pooled += observed[c];
      pooled_mass += mass[c];
      pooled_variance += variance[c];
    }
  }
  if (pooled_mass * draws >= 1) {
    add(pooled, pooled_mass, pooled_variance);
  } else if (pooled > 6) {
    result.p = 0;  // where none are expected
    return result;
  }
  if (degrees > 0) result.p = statistics::chi_square_p(statistic, degrees);
  return result;
}

}  // namespace lacuna::test
