#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "renderer/core/frame.h"
#include "renderer/core/sampling.h"
#include "tests/statistics.h"

namespace lacuna::statistics {

/// Cells on the sphere around a pole. Rings are as narrow as the lobe near the pole and grow
/// exponentially away from it, so that a sharp lobe is resolved and the rest is not forgotten.
class SphereGrid {
 public:
  /// `width`: of the lobe at the pole, radians; 1 or more for smooth densities.
  SphereGrid(const V3f& pole, double width, int rings = 10, int sectors = 12)
      : frame_(pole),
        width_(width),
        range_(std::asinh(pi_d / width)),
        rings_(rings),
        sectors_(sectors) {}

  std::size_t size() const {
    return static_cast<std::size_t>(rings_) * static_cast<std::size_t>(sectors_);
  }

  std::size_t cell_of(const V3f& w) const {
    const V3f l = frame_.to_local(w);
    const double theta = std::atan2(std::hypot(double(l.x), double(l.y)), double(l.z));
    const double phi = std::atan2(double(l.y), double(l.x));
    const int ring =
        std::min(static_cast<int>(std::asinh(theta / width_) / range_ * rings_), rings_ - 1);
    const int sector =
        std::min(static_cast<int>((phi / (2 * pi_d) + 0.5) * sectors_), sectors_ - 1);
    return static_cast<std::size_t>(ring) * static_cast<std::size_t>(sectors_) +
           static_cast<std::size_t>(sector);
  }

  /// Integral of `density(w)` over one cell, to about `tolerance`, by Gauss-Legendre rules that are
  /// refined where halving a piece changes the sum: at horizons and at peaks.
  template <class Density>
  double integrate(std::size_t cell, const Density& density, double tolerance) const {
    const auto sectors = static_cast<std::size_t>(sectors_);
    const std::size_t whole = cell / sectors;
    const auto ring = static_cast<double>(whole);
    const auto sector = static_cast<double>(cell % sectors);
    const Piece p{ring / rings_, (ring + 1) / rings_, (sector / sectors_ - 0.5) * 2 * pi_d,
                  ((sector + 1) / sectors_ - 0.5) * 2 * pi_d};
    return refine(p, rule(p, density), density, tolerance, 0);
  }

 private:
  static constexpr double pi_d = std::numbers::pi;
  struct Piece {
    double x0, x1, phi0, phi1;
  };

  template <class Density>
  double rule(const Piece& p, const Density& density) const {
    constexpr std::array<double, 3> at{-0.7745966692414834, 0, 0.7745966692414834};
    constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
    std::array<double, 3> cos_phi{}, sin_phi{};
    for (std::size_t j = 0; j < at.size(); ++j) {
      const double phi = 0.5 * (p.phi0 + p.phi1 + at[j] * (p.phi1 - p.phi0));
      cos_phi[j] = std::cos(phi);
      sin_phi[j] = std::sin(phi);
    }
    double sum = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double x = 0.5 * (p.x0 + p.x1 + at[i] * (p.x1 - p.x0));
      const double e = std::exp(x * range_);
      const double theta = width_ * 0.5 * (e - 1 / e);  // sinh; its derivative is cosh
      const double sin_theta = std::sin(theta);
      const auto z = static_cast<float>(std::cos(theta));
      const double ring = weight[i] * sin_theta * width_ * range_ * 0.5 * (e + 1 / e);
      for (std::size_t j = 0; j < at.size(); ++j) {
        const V3f w = frame_.to_world({static_cast<float>(sin_theta * cos_phi[j]),
                                       static_cast<float>(sin_theta * sin_phi[j]), z});
        sum += ring * weight[j] * density(w);
      }
    }
    return sum * (p.x1 - p.x0) * (p.phi1 - p.phi0);
  }

  template <class Density>
  double refine(const Piece& p, double coarse, const Density& density, double tolerance,
                int depth) const {
    const double x = 0.5 * (p.x0 + p.x1), phi = 0.5 * (p.phi0 + p.phi1);
    const std::array<Piece, 4> parts{Piece{p.x0, x, p.phi0, phi}, Piece{x, p.x1, p.phi0, phi},
                                     Piece{p.x0, x, phi, p.phi1}, Piece{x, p.x1, phi, p.phi1}};
    std::array<double, 4> fine{};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += fine[i] = rule(parts[i], density);
    // At least two halvings: a horizon may cut off just a corner.
    constexpr int deepest = 8;
    if ((std::abs(sum - coarse) < tolerance && depth >= 1) || depth == deepest) return sum;
    double result = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      result += refine(parts[i], fine[i], density, tolerance, depth + 1);
    }
    return result;
  }

  Frame frame_;
  double width_, range_;
  int rings_, sectors_;
};

/// Compares `n` draws with their density on the sphere. `region(w)` says which of `grids` counts a
/// direction, so that each lobe, and each side of a surface, can have a grid of its own. `draw()`
/// returns a direction, or nothing where it fails or draws from a delta: what the density leaves of
/// 1 is what is expected of that. `density(w)` is per steradian.
template <class RegionOf, class Draw, class Density>
ChiSquare sphere_chi_square(std::span<const SphereGrid> grids, const RegionOf& region, int n,
                            const Draw& draw, const Density& density) {
  std::vector<std::size_t> first{0};
  for (const SphereGrid& g : grids) first.push_back(first.back() + g.size());
  const std::size_t none = first.back();
  std::vector<double> observed(none + 1), expected(none + 1);
  for (int i = 0; i < n; ++i) {
    const std::optional<V3f> w = draw();
    std::size_t cell = none;
    if (w) {
      const std::size_t r = region(*w);
      cell = first[r] + grids[r].cell_of(*w);
    }
    ++observed[cell];
  }
  // One sample in 10^5: below the noise of a cell that is not pooled. Quadrature that
  // finds nothing at all is not to be trusted to the last sample either.
  constexpr double tolerance = 1e-5, least = 1e-7;
  double total = 0;
  for (std::size_t r = 0; r < grids.size(); ++r) {
    const auto here = [&](const V3f& w) { return region(w) == r ? double(density(w)) : 0.0; };
    for (std::size_t cell = 0; cell < grids[r].size(); ++cell) {
      const double p = grids[r].integrate(cell, here, tolerance);
      total += p;
      expected[first[r] + cell] = std::max(p, least) * n;
    }
  }
  expected[none] = std::max(1 - total, least) * n;
  ChiSquare result = chi_square_test(observed, expected);
  result.message += "; the density integrates to " + std::to_string(total) + ", " +
                    std::to_string(observed[none] / n) + " of the draws gave none";
  if (total > 1.001) result.p = 0;
  return result;
}

}  // namespace lacuna::statistics
