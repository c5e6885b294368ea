#include "renderer/path/splats.h"

#include <algorithm>

namespace lacuna {

void BandedSplats::arrange(std::size_t pixels) {
  const std::size_t band_size = (pixels + bands - 1) / bands;
  std::array<std::uint32_t, bands> count{};
  for (const Splat& s : splats_) ++count[s.pixel / band_size];
  for (std::size_t b = 0; b < bands; ++b) first_[b + 1] = first_[b] + count[b];
  std::array<std::uint32_t, bands> place{};
  std::copy_n(first_.begin(), bands, place.begin());
  order_.resize(splats_.size());
  for (std::uint32_t i = 0; i < splats_.size(); ++i) {
    order_[place[splats_[i].pixel / band_size]++] = i;
  }
}

}  // namespace lacuna
