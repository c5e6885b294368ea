#pragma once

#include <vector>

#include "renderer/connections/light_vertices.h"
#include "renderer/connections/resampling_table.h"

namespace lacuna {

/// A light path chosen for an eye vertex.
struct Pick {
  std::uint32_t path = 0;
  float probability = 0;   ///< of the choice, > 0
  std::uint8_t owner = 0;  ///< which of a site's distributions it belongs to
};

/// The distributions over light vertices at one place, for each length of light paths.
class Site {
 public:
  /// Of vertices with `s` vertices made from the light; in the order of LightVertices::joinable(s).
  void set(int s, ResamplingTable table) {
    if (tables_.size() < static_cast<std::size_t>(s)) tables_.resize(static_cast<std::size_t>(s));
    tables_[static_cast<std::size_t>(s) - 1] = std::move(table);
  }
  void clear() { tables_.clear(); }
  bool empty() const { return tables_.empty(); }

  const ResamplingTable& table(int s) const { return tables_[static_cast<std::size_t>(s) - 1]; }

  std::optional<Pick> pick(const LightVertices& lights, int s, Rng& rng) const {
    const ResamplingTable& t = table(s);
    if (t.empty()) return std::nullopt;
    const std::uint32_t i = t.sample(rng);
    return Pick{lights.joinable(s)[i], t.pmf(i).value, t.owner(i)};
  }

 private:
  std::vector<ResamplingTable> tables_;
};

/// One of the light paths that have `s` vertices, all alike.
inline std::optional<Pick> pick_uniformly(const LightVertices& lights, int s, Rng& rng,
                                          std::uint8_t owner) {
  const auto list = lights.joinable(s);
  if (list.empty()) return std::nullopt;
  const auto i = static_cast<std::size_t>((std::uint64_t{rng.next_u32()} * list.size()) >> 32);
  return Pick{list[i], 1 / static_cast<float>(list.size()), owner};
}

}  // namespace lacuna
