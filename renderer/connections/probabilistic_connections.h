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

/// A distribution over the light vertices of all lengths, in proportion to what they give to one
/// record: a length, then a vertex of that length.
class JointDistribution {
 public:
  void clear() {
    tables_.clear();
    cumulative_.assign(1, 0.0);
  }
  /// Appends the weights, >= 0, of the vertices of the next length.
  void append(std::span<const double> weights);

  /// A vertex LightVertices::at(s, index).
  struct Draw {
    int s;
    std::uint32_t index;
  };
  /// Nothing of up to `longest` vertices gives anything.
  bool empty(int longest) const { return !(total(longest) > 0); }
  /// Samples a vertex of those with s <= longest, which must not be empty.
  Draw sample(int longest, Rng& rng) const;
  /// Probability that sample() returns `d`; 0 if empty().
  double pmf(int longest, const Draw& d) const {
    if (empty(longest) || tables_[place(d.s) - 1].empty()) return 0;
    return (total(d.s) - total(d.s - 1)) / total(longest) *
           double(tables_[place(d.s) - 1].pmf(d.index).value);
  }

 private:
  static std::size_t place(int s) { return static_cast<std::size_t>(s); }
  /// Weight of the vertices of up to `s` from the light.
  double total(int s) const { return cumulative_[place(s)]; }

  std::vector<AliasTable> tables_;          // of s = 1, 2, ...
  std::vector<double> cumulative_ = {0.0};  // of s = 0, 1, ...
};

/// connections: probabilistic. An eye vertex draws light vertices from all of the shared paths and
/// of all lengths at once, by what they give to a record nearby, MIS weight included (Popov,
/// Ramamoorthi, Durand and Drettakis 2015). A share of the draws is uniform, so that none that a
/// record does not see is left out.
///
/// The paper's text was not at hand: this follows its abstract, Noel 2015 (4.3.4 and 11.6), and for
/// the count of correlated samples Grittmann et al. 2021, who take the paper's bound of the
/// variance to be the count of one sample.
class ProbabilisticConnections : public StrategyBase {
 public:
  explicit ProbabilisticConnections(const ProbabilisticConnectionsSettings& settings)
      : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 2> distributions{"records", "uniform"};

  static std::size_t cells() { return 1; }  // records are new in each iteration
  /// Traces the records and builds their distributions. Throws MemoryLimitError if there is no
  /// memory for them.
  void begin(const IterationContext& context, const LightVertices& lights, const CellStatistics&,
             Counters& counters);

  using CellLookup = EyeRecords::Near;
  CellLookup find(const Vertex& v, int /*depth*/, Rng&) const {
    return records_.nearest(v, settings_.neighbours);
  }

  /// SharedConnections::sample().
  template <class Survival, class Use>
  void sample(const CellLookup& lookup, const LightRange& range, Rng& rng, Survival&& survival,
              Use&& use) const {
    if (vertices_up_to(range.longest) == 0) return;
    for (int k = 0; k < settings_.draws; ++k) {
      const JointDistribution::Draw d = draw(lookup, range.longest, rng);
      const float p = survival(d.s);
      if (!(p > 0)) continue;
      range.lights.prefetch(d.s, d.index);
      VertexSample drawn = probability(lookup, range.longest, d);
      drawn.probability *= static_cast<float>(settings_.draws);
      drawn.survival = p;
      use(d.s, drawn);
    }
  }

  std::vector<std::pair<std::string, double>> statistics() const {
    return {{"records", static_cast<double>(records_.size())}};
  }

 private:
  std::uint64_t build(const EyeRecords::Record& record, JointDistribution& joint,
                      const IterationContext& context, const LightVertices& lights) const;
  JointDistribution::Draw draw(const CellLookup& lookup, int longest, Rng& rng) const;
  JointDistribution::Draw uniform_draw(int longest, Rng& rng) const;
  /// `d` with its probability in one draw.
  VertexSample probability(const CellLookup& lookup, int longest,
                           const JointDistribution::Draw& d) const;
  std::size_t vertices_up_to(int s) const { return counts_[static_cast<std::size_t>(s)]; }

  ProbabilisticConnectionsSettings settings_;
  EyeRecords records_;
  std::vector<JointDistribution> joint_of_records_;
  std::vector<std::size_t> counts_ = {0};  // of light vertices with up to s = 0, 1, ... from it
};

}  // namespace lacuna
