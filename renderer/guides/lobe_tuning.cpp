#include "renderer/guides/lobe_tuning.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

/// What a node uses until it has learned something: the thesis' values.
constexpr float first_strength = 8, first_probability = 0.5F;
/// Fewer paths than this have not told a node anything.
constexpr double least_paths = 8;

std::uint32_t nearest(const std::vector<float>& values, float wanted) {
  const auto closer = [wanted](float a, float b) {
    return std::abs(a - wanted) < std::abs(b - wanted);
  };
  return static_cast<std::uint32_t>(std::min_element(values.begin(), values.end(), closer) -
                                    values.begin());
}

}  // namespace

LobeTuning::LobeTuning(const SkeletonGuideSettings& settings, std::size_t nodes)
    : powers_(settings.strength.is_auto()) {
  if (powers_) {
    for (std::size_t k = 0; k < LobeSet::doublings; ++k) {
      strengths_.push_back(static_cast<float>(1U << k));
    }
  } else {
    strengths_ = {static_cast<float>(*settings.strength.value)};
  }
  if (settings.probability.is_auto()) {
    probabilities_ = {0, 0.125F, 0.25F, 0.375F, 0.5F, 0.625F, 0.75F, 0.875F};
  } else {
    probabilities_ = {static_cast<float>(*settings.probability.value)};
  }
  const std::uint32_t first =
      nearest(strengths_, first_strength) * static_cast<std::uint32_t>(count()) +
      nearest(probabilities_, first_probability);
  chosen_.assign(nodes, first);
  if (learns()) moments_.assign(nodes * stride(), 0.0);
}

void LobeTuning::learn(const Learned& what, const LobeSet& lobes, Tally& tally) const {
  const Vertex& v = what.v;
  const double energy = double(what.given) * double(what.given) * double(what.pdf.value);
  if (!(energy > 0) || !std::isfinite(energy)) return;
  std::array<float, LobeSet::doublings> densities{};
  if (powers_) {
    densities = lobes.pdf_of_powers(v.surface.x, what.wi);
  } else {
    densities[0] = lobes.pdf(v.surface.x, what.wi, strengths_[0]).value;
  }
  const float bsdf = v.bsdf->pdf(v.wp, what.wi, Transport::radiance).value;
  std::vector<double>& moments = tally.moments[v.site.index];
  moments.resize(stride());
  std::size_t i = 0;
  for (std::size_t s = 0; s < strengths_.size(); ++s) {
    for (const float c : probabilities_) {
      moments[i++] += energy / double(c * densities[s] + (1 - c) * bsdf);
    }
  }
  moments[i] = std::max(moments[i], energy / double(what.pdf.value));
  moments[i + 1] += 1;
}

void LobeTuning::end(std::span<const std::unique_ptr<Directions::Tally>> tallies) {
  std::vector<char> met(chosen_.size(), 0);
  for (const auto& t : tallies) {
    for (const auto& [node, moments] : static_cast<const Tally&>(*t).moments) {
      met[node] = 1;
      double* const all = moments_.data() + node * stride();
      for (std::size_t i = 0; i < stride(); ++i) {
        all[i] = i == candidates() ? std::max(all[i], moments[i]) : all[i] + moments[i];
      }
    }
  }
  for (std::size_t node = 0; node < met.size(); ++node) {
    if (met[node] != 0) choose(node);
  }
}

void LobeTuning::choose(std::size_t node) {
  if (paths(node) < least_paths) return;
  const double* const moments = moments_.data() + node * stride();
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < candidates(); ++i) {
    const double unseen = moments[candidates()] / (1 - double(probabilities_[i % count()]));
    if (moments[i] + unseen >= least) continue;
    least = moments[i] + unseen;
    chosen_[node] = static_cast<std::uint32_t>(i);
  }
}

void LobeTuning::load(ByteReader& in) {
  if (!learns()) return;
  std::vector<double> moments = in.get_vector<double>();
  if (moments.size() != moments_.size()) {
    throw std::runtime_error("saved strengths are of another skeleton");
  }
  moments_ = std::move(moments);
  for (std::size_t node = 0; node < chosen_.size(); ++node) choose(node);
}

std::vector<std::pair<std::string, double>> LobeTuning::statistics() const {
  if (!learns()) return {};
  std::size_t learned = 0;
  double logs = 0, shares = 0;
  for (std::size_t node = 0; node < chosen_.size(); ++node) {
    if (paths(node) < least_paths) continue;
    ++learned;
    logs += std::log2(double(strength(node)) + 1e-9);
    shares += double(probability(node));
  }
  const auto n = static_cast<double>(std::max<std::size_t>(learned, 1));
  return {{"nodes_learned", static_cast<double>(learned)},
          {"mean_strength", std::exp2(logs / n)},
          {"mean_probability", shares / n}};
}

}  // namespace lacuna
