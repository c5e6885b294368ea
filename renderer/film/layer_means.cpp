#include "renderer/film/layer_means.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "analysis/space/memory_limit.h"
#include "renderer/film/saved_values.h"

namespace lacuna {

namespace {

/// Bytes per pixel: its colour in the iteration, its sum, and its floats in image.exr, which is
/// encoded in memory.
constexpr std::uint64_t pixel_bytes = sizeof(Rgb) + 3 * sizeof(double) + 3 * sizeof(float);

}  // namespace

LayerMeans::LayerMeans(std::vector<std::string> names, int width, int height,
                       std::uint64_t byte_limit)
    : names_(std::move(names)), width_(width), height_(height) {
  if (names_.empty()) return;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const std::uint64_t bytes = names_.size() * pixels * pixel_bytes;
  if (bytes > byte_limit) {
    throw MemoryLimitError(fmt::format(
        "layers: {} images of {} x {} pixels, \"{}\" the first, would take {} bytes; allowed: {}",
        names_.size(), width, height, names_.front(), bytes, byte_limit));
  }
  values_ = 3 * pixels;
  sums_.reserve(names_.size());
  while (sums_.size() < names_.size()) {
    auto* const zeros = static_cast<double*>(std::calloc(values_, sizeof(double)));
    if (zeros == nullptr) throw std::bad_alloc();
    sums_.emplace_back(zeros, &std::free);
  }
}

std::span<Image> LayerMeans::begin(const ThreadPool& pool) {
  images_.resize(names_.size());
  pool.for_each(static_cast<int>(images_.size()), [&](int i) {
    Image& image = images_[static_cast<std::size_t>(i)];
    if (image.pixels.empty()) {
      image = Image(width_, height_);
    } else {
      std::fill(image.pixels.begin(), image.pixels.end(), Rgb(0, 0, 0));
    }
  });
  return images_;
}

void LayerMeans::add(const ThreadPool& pool) {
  ++iterations_;
  pool.for_each(static_cast<int>(images_.size()), [&](int i) {
    double* sum = sums_[static_cast<std::size_t>(i)].get();
    for (const Rgb& pixel : images_[static_cast<std::size_t>(i)].pixels) {
      for (const float v : {pixel.x, pixel.y, pixel.z}) *sum++ += double(v);
    }
  });
}

void LayerMeans::merge(const LayerMeans& other) {
  iterations_ += other.iterations_;
  for (std::size_t layer = 0; layer < sums_.size(); ++layer) {
    for (std::size_t i = 0; i < values_; ++i) sums_[layer][i] += other.sums_[layer][i];
  }
}

std::vector<double> LayerMeans::mean(std::size_t layer) const {
  std::vector<double> mean(sum(layer).begin(), sum(layer).end());
  for (double& v : mean) v /= divisor();
  return mean;
}

void LayerMeans::save(ByteWriter& out) const {
  for (std::size_t layer = 0; layer < sums_.size(); ++layer) out.put(sum(layer));
}

void LayerMeans::load(ByteReader& in, std::uint64_t iterations) {
  for (const Sum& sum : sums_) std::ranges::copy(get_finite(in, values_, "layer"), sum.get());
  iterations_ = iterations;
}

void LayerMeans::clear() {
  for (const Sum& sum : sums_) std::fill_n(sum.get(), values_, 0.0);
  iterations_ = 0;
}

}  // namespace lacuna
