#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The strength of a guide's lobes and its probability against the BSDF, for each cell (node or
/// region): as given in the settings, or learned. Learning estimates the second moment of a path's
/// contribution to its pixel for every candidate pair (strength, probability): a path that
/// contributed g, and whose direction was sampled with density q, adds g^2 q / p to the moment of a
/// candidate that has density p there. All candidates use the same paths, and the one with the
/// smallest product of moment and cost is chosen. As the tails of such sums are heavy, each cell
/// adds one more path like its largest, from a direction that the guide does not sample. The cost
/// is that of a vertex over one that follows the BSDF, a constant: clocks would change the bits.
///
/// Moments tell what a vertex gains if all others stay as they are, and along a path gains
/// multiply. So the noise of pixels is measured, and where the guide does not pay for its time it
/// is left alone from then on: idle(). Guided paths tell both their own noise and what it would be
/// if they followed the BSDF: such a ratio is known far better than that of two measured apart.
///
/// Pilots (GuidingDistribution::due_pilot()) tell that before the first iteration, whose paths
/// count in the picture: the first follow the BSDF, the others by turns the guide and the BSDF. A
/// guide that has not shown a gain by their end is idle, unless few paths make that ratio and the
/// BSDF finds no light in most pixels: then the guide begins, and later pilots follow the BSDF
/// until more is known, but for one that finds light in fewer pixels (directions that are learned
/// have 16 iterations in the dark to find more). A guide also ends where light is smooth: spread
/// samples of the BSDF do better there than any. Where the BSDF seldom finds
/// light, a guide begins that finds it in enough more pixels to pay, and is judged by the noise
/// after 16 iterations. An integrator without pilots compares where the choices of all cells
/// together seem to gain little: an iteration then follows the BSDF.
class Tuning {
 public:
  Tuning() = default;
  /// Those that are learned are expected to gain more with time.
  enum class Directions : std::uint8_t { fixed, learned };
  /// `strengths`: one or more candidates; `probability`: as in the settings.
  Tuning(std::vector<float> strengths, const AutoNumber& probability, std::size_t cells,
         Directions directions = Directions::fixed);

  bool learns() const { return strengths_.size() * probabilities_.size() > 1; }
  float strength(std::size_t cell) const { return choices_[chosen_[cell]].strength; }
  float probability(std::size_t cell) const {
    return idle_ || follows_bsdf() ? 0 : choices_[chosen_[cell]].probability;
  }

  /// Variances of single samples of pixels, each estimated from one pair of them; and what the same
  /// samples tell of the variance that following the BSDF would leave (GatheredLight).
  struct Noise {
    double sum = 0, squares = 0, pairs = 0, lit = 0;  // lit: pairs that differ
    double by_bsdf = 0, by_bsdf_squares = 0, products = 0;
    void add(double variance, double variance_by_bsdf) {
      add({variance, variance * variance, 1, variance > 0 ? 1.0 : 0.0, variance_by_bsdf,
           variance_by_bsdf * variance_by_bsdf, variance * variance_by_bsdf});
    }
    void add(const Noise& other);
    /// All that was added counts as `share` of it.
    void fade(double share);
    double mean() const { return sum / pairs; }
    /// The squared deviation of mean() over its square.
    double doubt() const { return squares / (sum * sum); }
    /// Logarithm of the ratio of the variance by the BSDF to that which was sampled.
    double log_gain() const { return std::log(by_bsdf / sum); }
    /// Its standard deviation: no less than 1 / sqrt(n) where n pairs of equal noise would tell as
    /// much. Few bright paths agree by chance, and make the linear estimate too small.
    double log_gain_deviation() const;
  };
  struct Accumulator {
    std::unordered_map<std::uint32_t, std::vector<double>>
        moments;  // by cell, laid out as moments_
    Noise noise;
    double bytes() const {
      double sum = map_bytes(moments);
      for (const auto& [cell, m] : moments) sum += double(m.capacity() * sizeof(m[0]));
      return sum;
    }
  };
  /// Whether the cell still learns. Each sample costs a density, so learning ends with enough
  /// paths.
  bool wants(std::uint32_t cell) const { return learns() && !idle_ && paths(cell) < enough_paths; }
  /// Requires wants(cell). `densities`: of sample.wi by the guide alone, for each strength.
  void accumulate(const GuidingSample& sample, std::uint32_t cell, std::span<const float> densities,
                  Accumulator& accumulator) const;
  /// `iterations`: as many as the accumulators hold, below 1 of a pilot.
  void update(std::span<const Accumulator* const> accumulators, double iterations);

  /// See GuidingDistribution.
  std::optional<std::uint64_t> due_pilot() const;
  void begin_pilot() { in_pilot_ = true; }

  /// All cells follow the BSDF, and nothing is learned any more.
  bool idle() const { return idle_; }
  /// Lets the coming iteration follow the BSDF where the moments of all cells do not tell that the
  /// choices surely pay for the time of guiding; update() then decides whether it is idle(). Only a
  /// probability that is learned can be 0. Call when the guide has had densities to judge by.
  void stop_if_useless();

  /// Adds a cell that starts as a copy of `cell`.
  void divide(std::size_t cell);
  /// Call when the guide's densities have changed: cells learn anew and keep their choice until
  /// they have.
  void forget() { fade(0); }
  /// The same, but what was learned counts as `share` of its paths.
  void fade(double share);
  /// Whether the cell's choice is one of the guide's directions, not the BSDF alone.
  bool guides(std::size_t cell) const { return !idle_ && probability(cell) > 0; }

  /// Writes nothing if it does not learn.
  void save(ByteWriter& out) const {
    if (!learns()) return;
    out.put(chosen_);
    out.put(moments_);
    out.put(noise_);
    out.put(decided_);
    out.put(with_);
    out.put(without_);
    out.put(pairs_);
    out.put(iterations_);
    out.put(rested_);
    out.put(pilots_);
    out.put(std::uint8_t{pays_});
    out.put(std::uint8_t{rests_});
    out.put(std::uint8_t{idle_});
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
  /// The cell's moment of a candidate, with the path that was not sampled; and times its cost.
  double moment(std::size_t cell, std::size_t candidate) const;
  double expense(std::size_t cell, std::size_t candidate) const;
  /// Pilots that follow the BSDF find light in at most this share of the pairs of pixels.
  bool finds_light_in_at_most(double share) const {
    return without_.pairs > 0 && without_.lit <= share * without_.pairs;
  }
  bool is_dark() const;
  /// The noise of a dark picture tells nothing before some iterations.
  bool noise_comes_later() const;
  /// Of all cells: the moment by the BSDF and that of the choices, the largest square, the paths.
  struct Sums {
    double plain = 0, chosen = 0, largest = 0, paths = 0;
    /// The light is so smooth that spread samples of the BSDF do better than any guide.
    bool smooth() const;
  };
  Sums sums() const;
  std::uint32_t cheapest(std::size_t cell) const;
  std::uint32_t carefully(std::size_t cell) const;
  void choose(std::size_t cell);
  /// What is sampled now follows the BSDF for comparison.
  bool follows_bsdf() const { return in_pilot_ ? !pilot_is_guided() : rests_; }
  bool pilot_is_guided() const;
  void judge_pilots();
  /// What the logarithm of the gain may be expected to grow by.
  double hoped() const;
  /// Below it a guide does not pay for its time, now or with what it may be expected to gain.
  double log_gain_that_pays() const;
  /// The guide surely finds light in enough more pairs of pixels to pay, in a picture whose noise
  /// is not known yet.
  bool begins_in_the_dark() const;
  /// Surely fewer pairs of pixels are lit with the guide, and that tells more than the noise.
  bool finds_too_little_light() const;
  void compare();

  struct Choice {
    float strength, probability;
  };

  std::vector<float> strengths_, probabilities_;
  std::vector<Choice> choices_;        // all candidates
  std::vector<std::uint32_t> chosen_;  // of each cell
  /// For each cell: the second moment of each strength and probability; the largest g^2 of a path;
  /// the number of paths.
  std::vector<double> moments_;
  double noise_ = 0;      // variances of pixels' samples with the guide, summed, faded as moments_
  double decided_ = 0;    // paths when it was last decided whether the guide pays
  Noise with_, without_;  // of iterations with the guide, the latest most, and of the others
  double pairs_ = 0;      // of a whole iteration, from the last update
  std::uint64_t iterations_ = 0, rested_ = 0, pilots_ = 0;
  Directions directions_ = Directions::fixed;
  bool pays_ = false;      // pilots have shown that the guide does
  bool in_pilot_ = false;  // what is sampled now is a pilot
  bool rests_ = false;     // the coming iteration follows the BSDF
  bool idle_ = false;
};

}  // namespace lacuna
