#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/race/noise.h"

namespace lacuna {

/// What one method has rendered of a picture, in two independent halves: their difference is the
/// error of the whole, also where samples are spread evenly (Sampler::sobol) and blocks have
/// different numbers of them.
class PictureHalves {
 public:
  PictureHalves() = default;
  explicit PictureHalves(const BlockGrid& grid);

  /// Adds an estimate of half 0 or 1: the sums of `counts` samples of each block.
  void add(std::uint32_t half, const Image& sums, std::span<const int> counts);
  /// Samples of each block so far.
  const std::vector<std::uint64_t>& drawn(std::uint32_t half) const { return drawn_[half]; }
  /// The mean number of samples of a pixel, of both halves.
  double samples() const;

  /// The squared error of the picture times the number of samples, summed over the pixels of each
  /// block: of independent samples the variance of one. None before each half has four estimates:
  /// with few, a few bright paths decide.
  std::optional<BlockSums> variances() const;

  /// For checkpoints. load() into one of the same grid; throws std::runtime_error on what save()
  /// never writes.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  BlockGrid grid_;
  std::array<Image, 2> sums_;  // empty until the first estimate
  std::array<std::vector<std::uint64_t>, 2> drawn_;
  std::array<std::uint64_t, 2> estimates_{};
};

}  // namespace lacuna
