#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// The layers of a bidirectional method: the contribution of each strategy (s, t), weighted and
/// unweighted, as in the pyramid of Noel 2015, Fig. 22, of merging, and of each resampling
/// distribution (Fig. 106).
class StrategyLayers {
 public:
  /// Selects the layers in `wanted` and returns their names, as Integrator::layers(), for paths of
  /// up to `max_depth` edges. `distributions`: names; empty: none.
  std::vector<std::string> choose(std::span<const ImageLayer> wanted, int max_depth,
                                  std::span<const std::string_view> distributions,
                                  bool merges = false);

  /// A contribution to a pixel.
  struct Sample {
    std::uint32_t pixel;
    Rgb unweighted;
    float weight;  ///< MIS
  };

  /// Adds a contribution of strategy (s, t). `layers`: IterationContext::layers.
  void strategy(std::span<Image> layers, int s, int t, const Sample& sample) const {
    if (!layers.empty()) add(layers, index(s, t), sample);
  }
  /// The same of merging vertex s of a light path with vertex t of an eye path, s >= 2, t >= 2:
  /// s + t - 2 edges. Requires choose() with `merges`.
  void merge(std::span<Image> layers, int s, int t, const Sample& sample) const {
    const int k = s + t - 2;
    if (!layers.empty()) add(layers, pyramid_ + (k - 2) * (k - 1) / 2 + s - 2, sample);
  }
  void distribution(std::span<Image> layers, int which, std::uint32_t pixel,
                    const Rgb& value) const {
    if (!layers.empty() && distributions_ >= 0) add(layers, distributions_ + which, pixel, value);
  }

 private:
  /// Index in the pyramid, whose rows are path lengths: k = s + t - 1 edges have k + 1 strategies,
  /// because nothing hits the eye (t >= 1).
  static int index(int s, int t) {
    const int k = s + t - 1;
    return (k - 1) * (k + 2) / 2 + s;
  }
  /// Adds to image `at` of the pyramid, weighted and unweighted.
  void add(std::span<Image> layers, int at, const Sample& s) const {
    if (weighted_ >= 0) add(layers, weighted_ + at, s.pixel, s.unweighted * s.weight);
    if (unweighted_ >= 0) add(layers, unweighted_ + at, s.pixel, s.unweighted);
  }
  static void add(std::span<Image> layers, int image, std::uint32_t pixel, const Rgb& value) {
    if (is_finite(value)) layers[static_cast<std::size_t>(image)].pixels[pixel] += value;
  }

  int pyramid_ = 0;  // images of strategies; those of merging follow
  int weighted_ = -1, unweighted_ = -1, distributions_ = -1;  // first image; -1: not wanted
};

}  // namespace lacuna
