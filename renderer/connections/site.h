#pragma once

#include <vector>

#include "renderer/connections/light_vertices.h"
#include "renderer/connections/resampling_table.h"

namespace lacuna {

/// A light vertex chosen for an eye vertex.
struct Pick {
  std::uint32_t index = 0;  ///< LightVertices::at(s, index)
  float probability = 0;    ///< of the choice, > 0
  std::uint8_t owner = 0;   ///< which of a site's distributions it belongs to
};

/// The distributions over light vertices at one place, for each length of light paths.
class Site {
 public:
  /// Over the vertices LightVertices::at(s, .).
  void set(int s, ResamplingTable table) {
    if (tables_.size() < static_cast<std::size_t>(s)) tables_.resize(static_cast<std::size_t>(s));
    tables_[static_cast<std::size_t>(s) - 1] = std::move(table);
  }
  void clear() { tables_.clear(); }
  bool empty() const { return tables_.empty(); }
  const ResamplingTable& table(int s) const { return tables_[static_cast<std::size_t>(s) - 1]; }

 private:
  std::vector<ResamplingTable> tables_;
};

/// Picks in two halves, `choose(s)` and `resolve(s, chosen)`, for all s in [1, longest] of which
/// there are vertices, and then calls `use(s, pick)`: what each step reads from memory was asked for in
/// the step before.
template <class Choose, class Resolve, class Use>
void pick_all(const LightVertices& lights, int longest, Choose&& choose, Resolve&& resolve,
              Use&& use) {
  constexpr int group = 8;
  std::array<std::uint32_t, group> chosen;
  std::array<Pick, group> picks;
  for (int first = 1; first <= longest; first += group) {
    const int n = std::min(group, longest - first + 1);
    for (int k = 0; k < n; ++k) {
      if (lights.count(first + k) > 0) chosen[static_cast<std::size_t>(k)] = choose(first + k);
    }
    for (int k = 0; k < n; ++k) {
      if (lights.count(first + k) == 0) continue;
      const auto i = static_cast<std::size_t>(k);
      picks[i] = resolve(first + k, chosen[i]);
      lights.prefetch(first + k, picks[i].index);
    }
    for (int k = 0; k < n; ++k) {
      if (lights.count(first + k) > 0) use(first + k, picks[static_cast<std::size_t>(k)]);
    }
  }
}

/// pick_all() of vertices that are all alike.
template <class Use>
void pick_uniformly(const LightVertices& lights, int longest, Rng& rng, std::uint8_t owner,
                    Use&& use) {
  pick_all(
      lights, longest,
      [&](int s) {
        return static_cast<std::uint32_t>((std::uint64_t{rng.next_u32()} * lights.count(s)) >> 32);
      },
      [&](int s, std::uint32_t i) {
        return Pick{i, 1 / static_cast<float>(lights.count(s)), owner};
      },
      use);
}

}  // namespace lacuna
