#pragma once

#include <array>
#include <random>
#include <vector>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/triangle_soup.h"
#include "analysis/parallel/thread_pool.h"

namespace lacuna {

/// Pools of one and of several threads: results are to be the same.
inline const ThreadPool& one_thread() {
  static const ThreadPool pool(1);
  return pool;
}
inline const ThreadPool& four_threads() {
  static const ThreadPool pool(4);
  return pool;
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

}  // namespace lacuna
