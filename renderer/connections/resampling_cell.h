#pragma once

#include <vector>

#include "renderer/connections/resampling_table.h"
#include "renderer/path/light_vertices.h"

namespace lacuna {

/// A light vertex sampled for an eye vertex.
struct VertexSample {
  std::uint32_t index = 0;        ///< LightVertices::at(s, index)
  float probability = 0;          ///< expected number of samples of this vertex, > 0
  std::uint8_t distribution = 0;  ///< index among the distributions of a node or record
  float survival = 1;             ///< probability of making the connection, > 0
};

/// The distributions over light vertices at one node or record, one for each length of light paths.
class ResamplingCell {
 public:
  /// Sets the distribution over the vertices LightVertices::at(s, .).
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

/// The light vertices with s in [1, longest].
struct LightRange {
  const LightVertices& lights;
  int longest;
};

/// For each s of the range that has vertices, samples a light vertex with probability `survival(s)`
/// and calls `use(s, sample)`. Sampling is split into `choose(s)` and `resolve(s, chosen)`: each
/// step prefetches the data of the next.
template <class Survival, class Choose, class Resolve, class Use>
void sample_connections(const LightRange& range, Survival&& survival, Choose&& choose,
                        Resolve&& resolve, Use&& use) {
  const auto& [lights, longest] = range;
  constexpr std::size_t group = 8;
  struct Chosen {
    int s;
    float survival;
    std::uint32_t index;
  };
  std::array<Chosen, group> chosen;
  std::array<VertexSample, group> samples;
  for (int s = 1; s <= longest;) {
    std::size_t n = 0;
    for (; s <= longest && n < group; ++s) {
      if (lights.count(s) == 0) continue;
      if (const float p = survival(s); p > 0) chosen[n++] = {s, p, choose(s)};
    }
    for (std::size_t k = 0; k < n; ++k) {
      samples[k] = resolve(chosen[k].s, chosen[k].index);
      samples[k].survival = chosen[k].survival;
      lights.prefetch(chosen[k].s, samples[k].index);
    }
    for (std::size_t k = 0; k < n; ++k) use(chosen[k].s, samples[k]);
  }
}

/// sample_connections() with equal probabilities of all vertices.
template <class Survival, class Use>
void sample_uniformly(const LightRange& range, Rng& rng, std::uint8_t distribution,
                      Survival&& survival, Use&& use) {
  sample_connections(
      range, survival,
      [&](int s) {
        return static_cast<std::uint32_t>((std::uint64_t{rng.next_u32()} * range.lights.count(s)) >>
                                          32);
      },
      [&](int s, std::uint32_t i) {
        return VertexSample{i, 1 / static_cast<float>(range.lights.count(s)), distribution};
      },
      use);
}

}  // namespace lacuna
