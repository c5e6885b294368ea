#include "renderer/visibility/visibility_guess.h"

#include "renderer/visibility/cached_visibility.h"
#include "renderer/visibility/gate_visibility.h"
#include "renderer/visibility/node_map_visibility.h"
#include "renderer/visibility/plain_visibility.h"
#include "renderer/visibility/view_map_visibility.h"

namespace lacuna {

namespace {

struct MakeSource {
  const ProbabilisticVisibilitySettings& cache;

  template <class V, class S, class Settings = S>
  static std::unique_ptr<GuessSource> make(const S&, const Settings& settings) {
    return std::make_unique<GuessOf<V>>(S::name, settings);
  }
  auto operator()(const CachePointsGuessSettings& s) const {
    return make<CachePointsGuess>(s, InterpolatedVisibilitySettings{
                                         cache.cache_points, cache.neighbours, cache.cache_lights});
  }
  auto operator()(const ViewMapsVisibilitySettings& s) const {
    return make<ViewMapVisibility>(s, s);
  }
  auto operator()(const NodeMapsVisibilitySettings& s) const {
    return make<NodeMapVisibility>(s, s);
  }
  auto operator()(const GatesVisibilitySettings& s) const { return make<GateVisibility>(s, s); }
  auto operator()(const CellsGuessSettings& s) const {
    return make<NoVisibility>(s, NoVisibilitySettings{});
  }
};

}  // namespace

std::vector<std::unique_ptr<GuessSource>> guess_sources(
    const ProbabilisticVisibilitySettings& settings) {
  const MakeSource make{settings};
  std::vector<std::unique_ptr<GuessSource>> sources;
  std::visit(
      [&]<class S>(const S& guess) {
        if constexpr (std::is_same_v<S, MixtureGuessSettings>) {
          for (const SourceSettings& s : guess.of) sources.push_back(std::visit(make, s));
        } else {
          sources.push_back(make(guess));
        }
      },
      settings.guess);
  return sources;
}

}  // namespace lacuna
