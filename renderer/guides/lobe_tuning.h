#pragma once

#include <array>
#include <unordered_map>

#include "renderer/guides/directions.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The strength of each node's lobes and the probability with which directions are drawn from them:
/// as given, or learned. What is learned is the variance that the directions from the node's
/// surroundings bring to the picture's pixels, for every candidate: with the density q that a
/// direction was drawn with and the density p that a candidate would have drawn it with, a path
/// that gave g to its pixel adds g^2 q / p to the candidate's second moment. All candidates learn
/// from the same paths, whichever drew them, and the one with the least is used. As the tails of
/// such sums are heavy, each node reckons with one more path like its largest that came from where
/// the lobes do not look.
class LobeTuning {
 public:
  LobeTuning() = default;
  LobeTuning(const SkeletonGuideSettings& settings, std::size_t nodes);

  bool learns() const { return strengths_.size() * probabilities_.size() > 1; }
  float strength(std::size_t node) const { return strengths_[chosen_[node] / count()]; }
  float probability(std::size_t node) const { return probabilities_[chosen_[node] % count()]; }

  struct Tally final : Directions::Tally {
    std::unordered_map<std::uint32_t, std::vector<double>> moments;  // of the nodes met, as below
  };
  /// `lobes`: of the node of `what`.
  void learn(const Learned& what, const LobeSet& lobes, Tally& tally) const;
  void end(std::span<const std::unique_ptr<Directions::Tally>> tallies);

  /// Nothing where nothing is learned.
  void save(ByteWriter& out) const {
    if (learns()) out.put(moments_);
  }
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  std::size_t count() const { return probabilities_.size(); }
  std::size_t candidates() const { return strengths_.size() * count(); }
  std::size_t stride() const { return candidates() + 2; }
  double paths(std::size_t node) const { return moments_[node * stride() + candidates() + 1]; }
  void choose(std::size_t node);

  bool powers_ = false;  // the strengths are 1, 2, 4, ...
  std::vector<float> strengths_, probabilities_;
  std::vector<std::uint32_t> chosen_;  // of each node
  /// Of each node: the second moment for each strength, of each probability; the largest of one
  /// path as it was drawn; the number of paths.
  std::vector<double> moments_;
};

}  // namespace lacuna
