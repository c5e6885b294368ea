#pragma once

#include <array>
#include <unordered_map>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// What a guide may learn for each of its places (nodes, regions): with which strength directions
/// are drawn, if it has strengths, and how often they are drawn from the guide instead of the BSDF;
/// as given, or learned. What is learned is the variance that the directions from a place bring to
/// the picture's pixels, for every candidate: with the density q that a direction was drawn with
/// and the density p that a candidate would have drawn it with, a path that gave g to its pixel
/// adds g^2 q / p to the candidate's second moment. All candidates learn from the same paths,
/// whichever drew them, and the one with the least is used. As the tails of such sums are heavy,
/// each place reckons with one more path like its largest that came from where the guide does not
/// look.
class Tuning {
 public:
  Tuning() = default;
  /// `strengths`: the candidates, any number above 0; `probability` as in settings.
  Tuning(std::vector<float> strengths, const AutoNumber& probability, std::size_t places);

  bool learns() const { return strengths_.size() * probabilities_.size() > 1; }
  float strength(std::size_t place) const { return strengths_[chosen_[place] / count()]; }
  float probability(std::size_t place) const { return probabilities_[chosen_[place] % count()]; }

  struct Tally {
    std::unordered_map<std::uint32_t, std::vector<double>> moments;  // of the places met, as below
  };
  /// Places that enough paths have told of learn nothing more: learning costs a density each.
  bool wants(std::uint32_t place) const { return learns() && paths(place) < enough_paths; }
  /// Only where it wants(). `densities`: with which the guide alone would draw what.wi, for each of
  /// the strengths.
  void learn(const GuidingSample& what, std::uint32_t place, std::span<const float> densities,
             Tally& tally) const;
  void end(std::span<const Tally* const> tallies);

  /// Nothing where nothing is learned.
  void save(ByteWriter& out) const {
    if (learns()) out.put(moments_);
  }
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  /// The mean of so many is known to 1 / sqrt(8192), about 1 %, of the spread of one.
  static constexpr double enough_paths = 8192;
  std::size_t count() const { return probabilities_.size(); }
  std::size_t candidates() const { return strengths_.size() * count(); }
  std::size_t stride() const { return candidates() + 2; }
  double paths(std::size_t place) const { return moments_[place * stride() + candidates() + 1]; }
  void choose(std::size_t place);

  std::vector<float> strengths_, probabilities_;
  std::vector<std::uint32_t> chosen_;  // of each place
  /// Of each place: the second moment for each strength, of each probability; the largest of one
  /// path as it was drawn; the number of paths.
  std::vector<double> moments_;
};

}  // namespace lacuna
