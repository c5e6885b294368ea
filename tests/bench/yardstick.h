#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "base/parallel/thread_pool.h"

namespace lacuna::bench {

/// Of each plane: that of a grid of 512^3, and all eight together exceed any cache.
inline constexpr std::size_t plane_bytes = std::size_t{1} << 24;
/// Of 36 measurements of four sweeps on a busy machine the standard deviation was 3 % of the mean;
/// of one sweep 11 %, and of as much work on planes that stay in a cache 10 %.
inline constexpr int sweeps = 4;

/// What times of the analysis are divided by, so that bounds hold on any machine: word-wide logic
/// over eight bit planes, as many as a cubical complex has, by all threads of a pool.
class Yardstick {
 public:
  /// `bytes` of each plane; `times` over all of them in one measurement.
  Yardstick(std::size_t bytes, int times) : times_(times), words_(bytes / sizeof(std::uint64_t)) {
    std::uint64_t word = 1;
    for (auto& plane : planes_) {
      plane.resize(words_);
      for (auto& w : plane) w = word = word * 6364136223846793005U + 1442695040888963407U;
    }
  }

  /// Seconds of one measurement, wall clock.
  double measure(const ThreadPool& pool) {
    const auto start = std::chrono::steady_clock::now();
    const auto threads = static_cast<std::size_t>(pool.threads());
    const std::size_t parts = 16 * threads;
    for (int s = 0; s < times_; ++s) {
      pool.for_each(static_cast<int>(parts), [&](int part) {
        const auto p = static_cast<std::size_t>(part);
        sweep(words_ * p / parts, words_ * (p + 1) / parts);
      });
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  /// Like the search for free faces: a cell with exactly one neighbour along an axis.
  void sweep(std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      std::uint64_t once = 0, twice = 0;
      for (const auto& plane : planes_) {
        for (const std::uint64_t near :
             {plane[i] << 1, plane[i] >> 1, plane[i] << 8, plane[i] >> 8}) {
          twice |= once & near;
          once |= near;
        }
      }
      planes_[7][i] ^= once & ~twice;
    }
  }

  int times_;
  std::size_t words_;
  std::array<std::vector<std::uint64_t>, 8> planes_;
};

}  // namespace lacuna::bench
