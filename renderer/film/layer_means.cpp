#include "renderer/film/layer_means.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/space/memory_limit.h"
#include "renderer/film/saved_values.h"

namespace lacuna {

namespace {

/// Of a pixel: its colour in the iteration, its sum, and its floats in image.exr, which is put
/// together in memory.
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
  sums_.assign(names_.size(), std::vector<double>(3 * pixels, 0.0));
}

std::span<Image> LayerMeans::begin(const ThreadPool& pool) {
  while (images_.size() < names_.size()) images_.emplace_back(width_, height_);
  pool.for_each(static_cast<int>(images_.size()), [&](int i) {
    std::vector<Rgb>& pixels = images_[static_cast<std::size_t>(i)].pixels;
    std::fill(pixels.begin(), pixels.end(), Rgb(0, 0, 0));
  });
  return images_;
}

void LayerMeans::add(const ThreadPool& pool) {
  ++iterations_;
  pool.for_each(static_cast<int>(images_.size()), [&](int i) {
    double* sum = sums_[static_cast<std::size_t>(i)].data();
    for (const Rgb& pixel : images_[static_cast<std::size_t>(i)].pixels) {
      for (const float v : {pixel.x, pixel.y, pixel.z}) *sum++ += double(v);
    }
  });
}

void LayerMeans::merge(const LayerMeans& other) {
  iterations_ += other.iterations_;
  for (std::size_t layer = 0; layer < sums_.size(); ++layer) {
    for (std::size_t i = 0; i < sums_[layer].size(); ++i) sums_[layer][i] += other.sums_[layer][i];
  }
}

std::vector<double> LayerMeans::mean(std::size_t layer) const {
  std::vector<double> mean = sums_[layer];
  for (double& v : mean) v /= divisor();
  return mean;
}

void LayerMeans::save(ByteWriter& out) const {
  for (const auto& sum : sums_) out.put(sum);
}

void LayerMeans::load(ByteReader& in, std::uint64_t iterations) {
  for (auto& sum : sums_) sum = get_finite(in, sum.size(), "layer");
  iterations_ = iterations;
}

void LayerMeans::clear() {
  for (auto& sum : sums_) std::fill(sum.begin(), sum.end(), 0.0);
  iterations_ = 0;
}

}  // namespace lacuna
