#pragma once

#include <array>
#include <unordered_map>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The strength of a guide's lobes and its probability against the BSDF, for each cell (node or
/// region): as given in the settings, or learned. Learning estimates the second moment of a path's
/// contribution to its pixel for every candidate pair (strength, probability): a path that
/// contributed g, and whose direction was sampled with density q, adds g^2 q / p to the moment of a
/// candidate that has density p there. All candidates use the same paths, and the one with the
/// smallest moment is chosen. As the tails of such sums are heavy, each cell adds one more path
/// like its largest, from a direction that the guide does not sample.
class Tuning {
 public:
  Tuning() = default;
  /// `strengths`: one or more candidates; `probability`: as in the settings.
  Tuning(std::vector<float> strengths, const AutoNumber& probability, std::size_t cells);

  bool learns() const { return strengths_.size() * probabilities_.size() > 1; }
  float strength(std::size_t cell) const { return strengths_[chosen_[cell] / count()]; }
  float probability(std::size_t cell) const { return probabilities_[chosen_[cell] % count()]; }

  struct Accumulator {
    std::unordered_map<std::uint32_t, std::vector<double>>
        moments;  // by cell, laid out as moments_
  };
  /// Whether the cell still learns. Each sample costs a density, so learning ends with enough
  /// paths.
  bool wants(std::uint32_t cell) const { return learns() && paths(cell) < enough_paths; }
  /// Requires wants(cell). `densities`: of sample.wi by the guide alone, for each strength.
  void accumulate(const GuidingSample& sample, std::uint32_t cell, std::span<const float> densities,
                  Accumulator& accumulator) const;
  void update(std::span<const Accumulator* const> accumulators);

  /// Adds a cell that starts as a copy of `cell`.
  void divide(std::size_t cell);
  /// Call when the guide's densities have changed: cells learn anew and keep their choice until
  /// they have.
  void forget();

  /// Writes nothing if it does not learn.
  void save(ByteWriter& out) const {
    if (!learns()) return;
    out.put(chosen_);
    out.put(moments_);
  }
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  /// Paths of a cell after which it stops learning: the mean of so many is known to 1 / sqrt(8192),
  /// about 1 %, of the spread of one.
  static constexpr double enough_paths = 8192;
  std::size_t count() const { return probabilities_.size(); }
  std::size_t candidates() const { return strengths_.size() * count(); }
  std::size_t stride() const { return candidates() + 2; }
  double paths(std::size_t cell) const { return moments_[cell * stride() + candidates() + 1]; }
  void choose(std::size_t cell);

  std::vector<float> strengths_, probabilities_;
  std::vector<std::uint32_t> chosen_;  // of each cell
  /// For each cell: the second moment of each strength and probability; the largest g^2 of a path;
  /// the number of paths.
  std::vector<double> moments_;
};

}  // namespace lacuna
