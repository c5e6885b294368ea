#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/path/path_letters.h"

namespace lacuna {

/// A contribution of a light path to any pixel. Splats are stored in the order they were made and
/// added to each pixel in the order of the parts that made them, so that sums have the same bits
/// for any number of threads.
struct Splat {
  static constexpr std::uint16_t any_length = 0;

  Rgb value;     ///< unweighted
  float weight;  ///< MIS
  std::uint32_t pixel;
  /// Vertices sampled from the light: the edges of the whole path. `any_length`: it stands for
  /// paths of several lengths, and is not added to the layers of light.
  std::uint16_t s;
  PathMatches matches = 0;
  bool of_layers_only = false;  ///< adds to the layers of light, not to the picture
};

using Splats = std::vector<Splat>;

/// The splats of a part, sorted by bands of the picture, so that several threads can add the splats
/// of many parts, each thread to a band of its own.
class BandedSplats {
 public:
  static constexpr std::size_t bands = 64;

  /// The part appends its splats here.
  Splats& splats() { return splats_; }
  /// Sorts them by band, for a picture of `pixels` pixels.
  void arrange(std::size_t pixels);
  /// Calls `use(splat)` for those in `band`, in the order they were made.
  template <class Use>
  void for_each_in(std::size_t band, Use&& use) const {
    for (std::uint32_t k = first_[band]; k < first_[band + 1]; ++k) use(splats_[order_[k]]);
  }
  void clear() { splats_.clear(); }

 private:
  Splats splats_;
  std::vector<std::uint32_t> order_;
  std::array<std::uint32_t, bands + 1> first_{};
};

}  // namespace lacuna
