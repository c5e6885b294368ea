#include "renderer/guides/tuning.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

/// The values of a cell that has not learned yet: the strength of the thesis, and half of its
/// probability, because the first iterations count like all others, and a wrong guide spoils them.
constexpr float first_strength = 8, first_probability = 0.25F;
/// Paths below which a cell keeps its initial values.
constexpr double min_paths = 8;

std::uint32_t nearest(const std::vector<float>& values, float wanted) {
  const auto closer = [wanted](float a, float b) {
    return std::abs(a - wanted) < std::abs(b - wanted);
  };
  return static_cast<std::uint32_t>(std::min_element(values.begin(), values.end(), closer) -
                                    values.begin());
}

}  // namespace

Tuning::Tuning(std::vector<float> strengths, const AutoNumber& probability, std::size_t cells)
    : strengths_(std::move(strengths)) {
  if (probability.is_auto()) {
    probabilities_ = {0, 0.125F, 0.25F, 0.375F, 0.5F, 0.625F, 0.75F, 0.875F};
  } else {
    probabilities_ = {static_cast<float>(*probability.value)};
  }
  const std::uint32_t first =
      nearest(strengths_, first_strength) * static_cast<std::uint32_t>(count()) +
      nearest(probabilities_, first_probability);
  chosen_.assign(cells, first);
  if (learns()) moments_.assign(cells * stride(), 0.0);
}

void Tuning::accumulate(const GuidingSample& sample, std::uint32_t cell,
                        std::span<const float> densities, Accumulator& accumulator) const {
  const Vertex& v = sample.v;
  const double energy = double(sample.pixel_contribution) * double(sample.pixel_contribution) *
                        double(sample.pdf.value);
  if (!(energy > 0) || !std::isfinite(energy)) return;
  const float bsdf = v.bsdf->pdf(v.wp, sample.wi, Transport::radiance).value;
  std::vector<double>& moments = accumulator.moments[cell];
  moments.resize(stride());
  std::size_t i = 0;
  for (const float density : densities) {
    for (const float c : probabilities_) {
      moments[i++] += energy / double(c * density + (1 - c) * bsdf);
    }
  }
  moments[i] = std::max(moments[i], energy / double(sample.pdf.value));
  moments[i + 1] += 1;
}

void Tuning::update(std::span<const Accumulator* const> accumulators) {
  std::vector<char> met(chosen_.size(), 0);
  for (const Accumulator* t : accumulators) {
    for (const auto& [cell, moments] : t->moments) {
      met[cell] = 1;
      double* const all = moments_.data() + cell * stride();
      for (std::size_t i = 0; i < stride(); ++i) {
        all[i] = i == candidates() ? std::max(all[i], moments[i]) : all[i] + moments[i];
      }
    }
  }
  for (std::size_t cell = 0; cell < met.size(); ++cell) {
    if (met[cell] != 0) choose(cell);
  }
}

void Tuning::choose(std::size_t cell) {
  if (paths(cell) < min_paths) return;
  const double* const moments = moments_.data() + cell * stride();
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < candidates(); ++i) {
    const double unseen = moments[candidates()] / (1 - double(probabilities_[i % count()]));
    if (moments[i] + unseen >= least) continue;
    least = moments[i] + unseen;
    chosen_[cell] = static_cast<std::uint32_t>(i);
  }
}

void Tuning::divide(std::size_t cell) {
  chosen_.push_back(chosen_[cell]);
  if (!learns()) return;
  const std::size_t from = cell * stride();
  for (std::size_t i = 0; i < stride(); ++i) moments_.push_back(moments_[from + i]);
}

void Tuning::forget() { std::fill(moments_.begin(), moments_.end(), 0.0); }

void Tuning::load(ByteReader& in) {
  if (!learns()) return;
  std::vector<std::uint32_t> chosen = in.get_vector<std::uint32_t>();
  std::vector<double> moments = in.get_vector<double>();
  const bool valid = std::all_of(chosen.begin(), chosen.end(),
                                 [this](std::uint32_t i) { return i < candidates(); });
  if (!valid || chosen.size() != chosen_.size() || moments.size() != moments_.size()) {
    throw std::runtime_error("saved strengths belong to another scene");
  }
  chosen_ = std::move(chosen);
  moments_ = std::move(moments);
}

std::vector<std::pair<std::string, double>> Tuning::statistics() const {
  if (!learns()) return {};
  std::size_t learned = 0;
  double logs = 0, shares = 0;
  for (std::size_t cell = 0; cell < chosen_.size(); ++cell) {
    if (paths(cell) < min_paths) continue;
    ++learned;
    logs += std::log2(double(strength(cell)) + 1e-9);
    shares += double(probability(cell));
  }
  const auto n = static_cast<double>(std::max<std::size_t>(learned, 1));
  return {{"places_learned", static_cast<double>(learned)},
          {"mean_strength", std::exp2(logs / n)},
          {"mean_probability", shares / n}};
}

}  // namespace lacuna
