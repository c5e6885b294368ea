#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/parallel/thread_pool.h"
#include "renderer/film/image.h"

namespace lacuna {

/// The images that an integrator fills beside the picture (Integrator::layers()): those of the
/// iteration at hand, and their means over all iterations, in double. No variance is kept. Without
/// names nothing is allocated, and nothing saved.
class LayerMeans {
 public:
  LayerMeans() = default;
  /// One image of `width` x `height` pixels a name. Throws MemoryLimitError, before it allocates,
  /// if these, their means and a checkpoint of them would take more than `byte_limit` bytes.
  LayerMeans(std::vector<std::string> names, int width, int height, std::uint64_t byte_limit);

  const std::vector<std::string>& names() const { return names_; }

  /// The images for the next iteration, in the order of the names, black: what they held is gone.
  std::span<Image> begin(const ThreadPool& pool);
  /// Adds the images as those of one more iteration. Their values are finite.
  void add(const ThreadPool& pool);

  /// Mean over all iterations, RGB interleaved. All zero before the first.
  std::vector<double> mean(std::size_t layer) const;

  /// The state as bytes and back, for checkpoints; `iterations`: how many were added to what was
  /// saved. load() throws std::runtime_error on another size and on values that are not finite;
  /// what this holds then is good for clear() alone.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in, std::uint64_t iterations);
  /// As before the first iteration.
  void clear();

 private:
  std::vector<std::string> names_;
  std::vector<Image> images_;
  std::vector<std::vector<double>> sums_;
  std::uint64_t iterations_ = 0;
};

}  // namespace lacuna
