#include "renderer/integrators/strategy_layers.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacuna {

std::vector<std::string> StrategyLayers::choose(std::span<const ImageLayer> wanted, int max_depth,
                                                std::span<const std::string_view> distributions,
                                                bool merges) {
  pyramid_ = max_depth * (max_depth + 3) / 2;
  std::vector<std::string> names;
  const auto take = [&](ImageLayer layer, int& first, const auto& list) {
    if (std::find(wanted.begin(), wanted.end(), layer) == wanted.end()) return;
    first = static_cast<int>(names.size());
    list(enum_name(layer));
  };
  const auto pyramid = [&](std::string_view layer) {
    for (int k = 1; k <= max_depth; ++k) {
      for (int s = 0; s <= k; ++s) names.push_back(fmt::format("{}.s{}t{}", layer, s, k + 1 - s));
    }
    for (int k = 2; merges && k <= max_depth; ++k) {
      for (int s = 2; s <= k; ++s) names.push_back(fmt::format("{}.s{}t{}m", layer, s, k + 2 - s));
    }
  };
  take(ImageLayer::strategies, weighted_, pyramid);
  take(ImageLayer::strategies_unweighted, unweighted_, pyramid);
  if (distributions.empty()) return names;
  take(ImageLayer::distributions, distributions_, [&](std::string_view layer) {
    for (const std::string_view d : distributions) names.push_back(fmt::format("{}.{}", layer, d));
  });
  return names;
}

}  // namespace lacuna
