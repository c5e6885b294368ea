#pragma once

#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/geometry/bit_grid.h"
#include "analysis/space/domain.h"

namespace lacuna::bench {

/// The empty voxels of a grid of the thesis author's (uncompressed: 3 x int32 size, then a byte a
/// voxel, 1 is scene). Throws std::runtime_error.
inline BitGrid3 read_grid(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<std::int32_t, 3> n{};
  if (!in.read(reinterpret_cast<char*>(n.data()), sizeof n)) {
    throw std::runtime_error(file + " cannot be read");
  }
  BitGrid3 domain(Imath::V3i(n[0], n[1], n[2]));
  std::vector<char> row(static_cast<std::size_t>(n[0]));
  for (int z = 0; z < n[2]; ++z) {
    for (int y = 0; y < n[1]; ++y) {
      if (!in.read(row.data(), n[0])) throw std::runtime_error(file + " ends early");
      for (int x = 0; x < n[0]; ++x) {
        if (row[static_cast<std::size_t>(x)] == 0) domain.set(x, y, z);
      }
    }
  }
  return domain;
}

/// The empty voxels of a grid of side^3 whose scene is random balls, 10 % of it: hundreds of
/// cavities' walls.
inline BitGrid3 random_blobs(int side) {
  BitGrid3 domain = empty_voxels(BitGrid3(Imath::V3i(side)));
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(0, 1);
  const auto voxels = static_cast<double>(side) * side * side;
  for (double filled = 0; filled < 0.105 * voxels;) {
    const double r = side * (0.008 + 0.032 * u(rng));
    const Imath::V3d c(u(rng) * side, u(rng) * side, u(rng) * side);
    filled += 4.19 * r * r * r;
    const auto range = [&](double at) {
      return std::pair{std::max(0, static_cast<int>(at - r)), std::min<double>(side, at + r)};
    };
    const auto [x0, x1] = range(c.x);
    const auto [y0, y1] = range(c.y);
    const auto [z0, z1] = range(c.z);
    for (int z = z0; z < z1; ++z) {
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          if ((Imath::V3d(x, y, z) - c).length2() < r * r) domain.reset({x, y, z});
        }
      }
    }
  }
  return domain;
}

/// A grid with a pebble of one voxel at each third place, n^3 of them, none at its border.
inline BitGrid3 pebbles(int n) {
  BitGrid3 domain = empty_voxels(BitGrid3(Imath::V3i(3 * n + 1)));
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) domain.reset({3 * x + 2, 3 * y + 2, 3 * z + 2});
    }
  }
  return domain;
}

}  // namespace lacuna::bench
