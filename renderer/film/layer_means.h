#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "renderer/film/image.h"

namespace lacuna {

/// The images that an integrator writes besides the picture (Integrator::layers()): those of the
/// current iteration, and their means over all iterations, in double, without variance. Without
/// names nothing is allocated or saved.
class LayerMeans {
 public:
  LayerMeans() = default;
  /// One image of `width` x `height` pixels for each name. Throws MemoryLimitError, before it
  /// allocates, if the images, their means and image.exr need more than `byte_limit` bytes.
  LayerMeans(std::vector<std::string> names, int width, int height, std::uint64_t byte_limit);

  const std::vector<std::string>& names() const { return names_; }

  /// Clears the images to black and returns them, in the order of the names, for the next
  /// iteration.
  std::span<Image> begin(const ThreadPool& pool);
  /// Adds the images, whose values must be finite, to the means as one iteration.
  void add(const ThreadPool& pool);

  /// Adds the iterations of `other`, which has the same names and size. Sums of doubles: their last
  /// digit depends on the order.
  void merge(const LayerMeans& other);

  /// The sum over all iterations, interleaved RGB, and the divisor that makes it their mean.
  std::span<const double> sum(std::size_t layer) const { return {sums_[layer].get(), values_}; }
  double divisor() const { return iterations_ > 0 ? static_cast<double>(iterations_) : 1.0; }
  /// Mean over all iterations, interleaved RGB. Zero before the first iteration.
  std::vector<double> mean(std::size_t layer) const;

  /// Saves and restores the state, for checkpoints. `iterations`: the number of iterations of the
  /// saved state. load() throws std::runtime_error on another size and on values that are not
  /// finite; afterwards only clear() may be called.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in, std::uint64_t iterations);
  /// Resets to the state before the first iteration.
  void clear();

 private:
  /// From calloc: the system clears each page at its first use, by the workers in add(), so
  /// hundreds of layers delay neither start nor stop.
  using Sum = std::unique_ptr<double[], decltype(&std::free)>;
  std::span<double> sum(std::size_t layer) { return {sums_[layer].get(), values_}; }

  std::vector<std::string> names_;
  int width_ = 0, height_ = 0;
  std::size_t values_ = 0;     // in each sum
  std::vector<Image> images_;  // allocated by the first begin(): merging alone needs none
  std::vector<Sum> sums_;
  std::uint64_t iterations_ = 0;
};

}  // namespace lacuna
