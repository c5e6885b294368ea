#pragma once

#include <algorithm>
#include <array>

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/eye_records.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/core/alias_table.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// A distribution over the light vertices of all lengths, in proportion to their contributions to
/// one record: a length, then a vertex of that length.
class JointDistribution {
 public:
  void clear() {
    tables_.clear();
    cumulative_.assign(1, 0.0);
  }
  /// Appends the weights, >= 0, of the vertices of the next length.
  void append(std::span<const double> weights);

  /// A vertex LightVertices::at(s, index).
  struct Sample {
    int s;
    std::uint32_t index;
  };
  /// Whether all vertices with s <= longest have weight 0.
  bool empty(int longest) const { return !(total(longest) > 0); }
  /// Samples a vertex with s <= longest. Requires !empty(longest).
  Sample sample(int longest, Rng& rng) const;
  /// Probability that sample() returns `d`; 0 if empty(longest).
  double pmf(int longest, const Sample& d) const {
    if (empty(longest) || tables_[place(d.s) - 1].empty()) return 0;
    return (total(d.s) - total(d.s - 1)) / total(longest) *
           double(tables_[place(d.s) - 1].pmf(d.index).value);
  }

 private:
  static std::size_t place(int s) { return static_cast<std::size_t>(s); }
  /// Total weight of the vertices up to length `s`.
  double total(int s) const { return cumulative_[place(s)]; }

  std::vector<AliasTable> tables_;          // for s = 1, 2, ...
  std::vector<double> cumulative_ = {0.0};  // for s = 0, 1, ...
};

/// connections: probabilistic. For an eye vertex, samples light vertices from all shared paths and
/// lengths at once, by their contributions to a nearby record, including MIS weights (Popov,
/// Ramamoorthi, Durand and Drettakis 2015). A fraction of the samples is uniform, so vertices
/// occluded from a record keep a positive probability.
///
/// The paper's text was not available: this follows its abstract and Noel 2015 (4.3.4 and 11.6),
/// and, for the count of correlated samples, Grittmann et al. 2021, who identify the paper's bound
/// of the variance with the count of one sample.
class ProbabilisticConnections : public StrategyBase {
 public:
  explicit ProbabilisticConnections(const ProbabilisticConnectionsSettings& settings)
      : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 2> distributions{"records", "uniform"};

  static std::size_t cells() { return 1; }  // records change in each iteration
  /// Traces the records and builds their distributions. Throws MemoryLimitError if there is no
  /// memory for them.
  void begin(const IterationContext& context, const LightVertices& lights, const CellStatistics&,
             Counters& counters);

  using CellLookup = EyeRecords::Neighbours;
  CellLookup find(const Vertex& v, int /*depth*/, Rng&) const {
    return records_.nearest(v, settings_.neighbours);
  }

  /// SharedConnections::sample().
  template <class Survival, class Use>
  void sample(const CellLookup& lookup, const LightRange& range, Rng& rng, Survival&& survival,
              Use&& use) const {
    if (vertices_up_to(range.longest) == 0) return;
    for (int k = 0; k < settings_.draws; ++k) {
      const JointDistribution::Sample vertex = sample_vertex(lookup, range.longest, rng);
      const float p = survival(vertex.s);
      if (!(p > 0)) continue;
      range.lights.prefetch(vertex.s, vertex.index);
      VertexSample sample = probability(lookup, range.longest, vertex);
      sample.probability *= static_cast<float>(settings_.draws);
      sample.survival = p;
      use(vertex.s, sample);
    }
  }

  std::vector<std::pair<std::string, double>> statistics() const {
    return {{"records", static_cast<double>(records_.size())}};
  }

 private:
  std::uint64_t build(const EyeRecords::Record& record, JointDistribution& joint,
                      const IterationContext& context, const LightVertices& lights) const;
  JointDistribution::Sample sample_vertex(const CellLookup& lookup, int longest, Rng& rng) const;
  JointDistribution::Sample sample_uniform_vertex(int longest, Rng& rng) const;
  /// `d` with its probability in one sample.
  VertexSample probability(const CellLookup& lookup, int longest,
                           const JointDistribution::Sample& d) const;
  std::size_t vertices_up_to(int s) const { return counts_[static_cast<std::size_t>(s)]; }

  ProbabilisticConnectionsSettings settings_;
  EyeRecords records_;
  std::vector<JointDistribution> joint_of_records_;
  std::vector<std::size_t> counts_ = {0};  // light vertices of length up to s = 0, 1, ...
};

}  // namespace lacuna
