#include "renderer/race/picture_halves.h"

#include <algorithm>
#include <stdexcept>

#include "renderer/film/film.h"
#include "renderer/film/saved_values.h"

namespace lacuna {

PictureHalves::PictureHalves(const BlockGrid& grid) : grid_(grid) {
  for (auto& counts : drawn_) counts.assign(grid.blocks(), 0);
}

void PictureHalves::add(std::uint32_t half, const Image& sums, std::span<const int> counts) {
  if (sums_[0].pixels.empty()) sums_.fill(Image(grid_.width, grid_.height));
  for (std::size_t i = 0; i < sums.pixels.size(); ++i) sums_[half].pixels[i] += sums.pixels[i];
  for (std::size_t b = 0; b < counts.size(); ++b) {
    drawn_[half][b] += static_cast<std::uint64_t>(counts[b]);
  }
  ++estimates_[half];
}

double PictureHalves::samples() const {
  double sum = 0;
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      const std::size_t b = grid_.block_of(x, y);
      sum += double(drawn_[0][b] + drawn_[1][b]);
    }
  }
  return sum / double(grid_.pixels());
}

std::optional<BlockSums> PictureHalves::variances() const {
  constexpr std::uint64_t fewest = 4;
  if (std::min(estimates_[0], estimates_[1]) < fewest) return std::nullopt;
  BlockSums sums(grid_.blocks(), 0.0);
  std::size_t i = 0;
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x, ++i) {
      const std::size_t b = grid_.block_of(x, y);
      const auto n0 = double(drawn_[0][b]), n1 = double(drawn_[1][b]);
      const Rgb d = sums_[0].pixels[i] / float(n0) - sums_[1].pixels[i] / float(n1);
      const double square = (double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z) / 3;
      sums[b] += square * scale_from_halves(n0, n1) * (n0 + n1);
    }
  }
  return sums;
}

void PictureHalves::save(ByteWriter& out) const {
  out.put(estimates_);
  for (const auto& counts : drawn_) out.put(counts);
  out.put(sums_[0].pixels.empty());
  if (sums_[0].pixels.empty()) return;
  for (const Image& sum : sums_) put_image(out, sum);
}

void PictureHalves::load(ByteReader& in) {
  estimates_ = in.get<std::array<std::uint64_t, 2>>();
  for (auto& counts : drawn_) {
    const std::size_t blocks = counts.size();
    counts = in.get_vector<std::uint64_t>();
    if (counts.size() != blocks) throw std::runtime_error("saved samples are of other blocks");
  }
  sums_ = {};
  if (in.get<std::uint8_t>() != 0) return;
  sums_.fill(Image(grid_.width, grid_.height));
  for (Image& sum : sums_) get_image(in, sum, "half of a picture");
  for (const auto& counts : drawn_) {
    if (std::find(counts.begin(), counts.end(), 0U) != counts.end() && estimates_[0] > 0 &&
        estimates_[1] > 0) {
      throw std::runtime_error("saved half of a picture has blocks without samples");
    }
  }
}

}  // namespace lacuna
