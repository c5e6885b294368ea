#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/triangle_soup.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Pools of one and of several threads: results are to be the same. Two pools that live at the same
/// time share the smaller's number of threads, so each lives for one call.
inline ThreadPool one_thread() { return ThreadPool(1); }
inline ThreadPool four_threads() { return ThreadPool(4); }

inline std::uint32_t l1(Imath::V3i d) {
  return static_cast<std::uint32_t>(std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
}
inline std::uint32_t chebyshev(Imath::V3i d) {
  return static_cast<std::uint32_t>(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
}

/// Every bit 1 with probability `share`.
inline BitGrid3 random_grid(Imath::V3i size, double share, std::mt19937& rng) {
  BitGrid3 grid(size);
  std::bernoulli_distribution bit(share);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (bit(rng)) grid.set(x, y, z);
  return grid;
}

/// The complement of random balls: a domain with larger rooms than random bits have.
inline BitGrid3 random_rooms(Imath::V3i size, int balls, double max_radius, std::mt19937& rng) {
  BitGrid3 grid(size);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) grid.set(x, y, z);
  std::uniform_real_distribution<double> u(0, 1);
  for (int b = 0; b < balls; ++b) {
    const Imath::V3d c(u(rng) * size.x, u(rng) * size.y, u(rng) * size.z);
    const double r = u(rng) * max_radius;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          if ((Imath::V3d(x, y, z) - c).length2() < r * r) grid.reset({x, y, z});
  }
  return grid;
}

/// Grids of many shapes: 1 bits, noise and rooms, sides from 1 on, also across the 8 of a block.
inline std::vector<BitGrid3> small_grids(unsigned seed) {
  std::mt19937 rng(seed);
  std::vector<BitGrid3> grids;
  for (const Imath::V3i& size :
       {Imath::V3i(1, 1, 1), Imath::V3i(7, 1, 1), Imath::V3i(1, 9, 1), Imath::V3i(1, 1, 17),
        Imath::V3i(2, 3, 4), Imath::V3i(9, 8, 7), Imath::V3i(16, 5, 11), Imath::V3i(13, 14, 6)}) {
    for (const double share : {0.0, 0.3, 0.8, 0.97, 1.0})
      grids.push_back(random_grid(size, share, rng));
    grids.push_back(random_rooms(size, 3, 2.5, rng));
  }
  return grids;
}

inline void add_triangle(TriangleSoup& soup, Imath::V3d a, Imath::V3d b, Imath::V3d c) {
  const auto i = static_cast<std::uint32_t>(soup.positions.size());
  for (const Imath::V3d& p : {a, b, c}) soup.positions.emplace_back(p);
  soup.triangles.push_back({i, i + 1, i + 2});
}

/// A point makes the grid larger and nothing else.
inline void add_point(TriangleSoup& soup, Imath::V3d p) { add_triangle(soup, p, p, p); }

/// A random rotation, as three orthonormal axes.
inline std::array<Imath::V3d, 3> random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> g;
  const Imath::V3d z = Imath::V3d(g(rng), g(rng), g(rng)).normalized();
  const Imath::V3d x = z.cross(Imath::V3d(g(rng), g(rng), g(rng))).normalized();
  return {x, z.cross(x), z};
}

/// A closed box without thickness: 12 triangles, half sides `half` along `axes`.
inline void add_box(TriangleSoup& soup, Imath::V3d centre, const std::array<Imath::V3d, 3>& axes,
                    Imath::V3d half) {
  const auto corner = [&](int i) {
    Imath::V3d p = centre;
    for (int a = 0; a < 3; ++a)
      p += axes[static_cast<std::size_t>(a)] * half[a] * (i >> a & 1 ? 1 : -1);
    return p;
  };
  for (int a = 0; a < 3; ++a)
    for (const int side : {0, 1 << a}) {
      const int u = 1 << (a + 1) % 3, v = 1 << (a + 2) % 3;
      add_triangle(soup, corner(side), corner(side | u), corner(side | u | v));
      add_triangle(soup, corner(side), corner(side | u | v), corner(side | v));
    }
}

/// A closed sphere without thickness of 2 * n * n triangles, some of them degenerate at its poles.
inline void add_sphere(TriangleSoup& soup, Imath::V3d centre, const std::array<Imath::V3d, 3>& axes,
                       double radius, int n) {
  const auto point = [&](int i, int j) {
    const double theta = M_PI * i / n, phi = 2 * M_PI * (j % n) / n;
    const double s = i == 0 || i == n ? 0 : std::sin(theta);
    return centre + radius * (axes[0] * s * std::cos(phi) + axes[1] * s * std::sin(phi) +
                              axes[2] * std::cos(theta));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      add_triangle(soup, point(i, j), point(i + 1, j), point(i + 1, j + 1));
      add_triangle(soup, point(i, j), point(i + 1, j + 1), point(i, j + 1));
    }
}

}  // namespace lacuna
