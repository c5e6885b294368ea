#include "renderer/guides/efficiency_roulette.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace lacuna {

namespace {

/// Rare light is missing in the moments of most cells: at .05 (the paper's) a path that is the
/// first to find it counts 20 times, and on sponza such paths carry the error; at .5 there is less
/// to gain.
constexpr float min_survival = 1.0F / 3;
constexpr float max_parts = 8;
constexpr float split_from = 1.5F;  // rounds to two parts
/// Iterations of the first two spans. From 8 on less is left of the budgets of a few seconds.
constexpr std::uint32_t first_span = 4;
/// Variance over what the halves tell. Samples that gain that much in the first span gain more in
/// longer ones, and roulette and branches would lose it: on area .37 is left of the efficiency.
constexpr double well_spread = 1.15;
/// Of a round; with fewer the fixed point is not reached: on corridor the variance falls until
/// some 60 iterations of 30,000 continuations.
constexpr double enough_samples = 1 << 20;
/// The share of the pixels that differ most, without which paths end. With none `nave` has a third
/// of its efficiency, as rare paths decide; with 1/128 sponza gains half as much.
constexpr double trimmed_share = 1.0 / 32;
/// Of `spread`: the least V_I by which paths end, where most pixels are black.
constexpr double least_trimmed = 0x1p-20;
/// What a sample costs besides its rays, in rays: measured on door and cornell.
constexpr double rays_of_sample = 0.5;

/// The sum of `values` without the largest share of them.
double trimmed_sum(std::vector<double> values) {
  const auto kept = static_cast<std::ptrdiff_t>((1 - trimmed_share) * double(values.size()));
  const auto end = values.begin() + kept;
  std::nth_element(values.begin(), end, values.end());
  return std::accumulate(values.begin(), end, 0.0);
}

}  // namespace

EfficiencyRoulette::EfficiencyRoulette(const Scene& scene, std::size_t pixels)
    : pixels_(pixels),
      moments_(scene.bounds().low, scene.bounds().size(), classes, enough_samples) {
  for (auto& half : sums_) half.assign(pixels, 0.0);
  state_.span = first_span;
}

float EfficiencyRoulette::continuations(const Vertex& v, int edges_left, float throughput) const {
  const ReflectedRadiance::Moments m = moments_.moments(v, vertex_class(edges_left));
  if (m.mean < 0) return -1;
  return continuations(m, throughput * state_.for_survival, throughput * state_.for_splitting);
}

float EfficiencyRoulette::continuations(const ReflectedRadiance::Moments& m, float for_survival,
                                        float for_splitting) {
  const float rays = std::max(m.rays, 1.0F);
  const float survival = for_survival * std::sqrt(m.square / rays);
  if (!(survival >= 1)) return std::max(survival, min_survival);
  const float variance = std::max(m.square - m.mean * m.mean, 0.0F);
  const float parts = for_splitting * std::sqrt(variance / rays);
  return parts < split_from ? 1 : std::min(parts, max_parts);
}

void EfficiencyRoulette::update(std::span<const Accumulator> accumulators,
                                const IterationContext& context, const Image& image,
                                const Counters& sum) {
  if (learns()) {
    for (const Accumulator& part : accumulators) {
      for (const Continuation& c : part) moments_.add(c.cell, {c.value, double(c.rays)});
    }
    moments_.end_iteration();
  }
  if (!observes()) return;
  const std::size_t half = context.iteration % 2;
  for (std::size_t i = 0; i < pixels_; ++i) {
    const double value = luminance(image.pixels[i]);
    if (!std::isfinite(value)) continue;
    sums_[half][i] += value;
    state_.squares += value * value;
  }
  ++state_.iterations[half];
  state_.rays += double(sum.rays + sum.shadow_rays);
  state_.samples += double(sum.samples);
  if (state_.iterations[0] + state_.iterations[1] == state_.span) end_span();
}

EfficiencyRoulette::Efficiency EfficiencyRoulette::measured() const {
  const double even = state_.iterations[0], odd = state_.iterations[1], n = even + odd;
  const double pixels = double(pixels_);
  double squared_means = 0, squares = 0;
  std::vector<double> differences;  // variances of a sample, by the halves of each pixel
  differences.reserve(pixels_);
  for (std::size_t i = 0; i < pixels_; ++i) {
    const double mean = (sums_[0][i] + sums_[1][i]) / n;
    squared_means += mean * mean;
    if (even == 0 || odd == 0) continue;
    const double d = sums_[0][i] / even - sums_[1][i] / odd;
    const double v = d * d / (1 / even + 1 / odd);
    differences.push_back(v);
    squares += v * v;
  }
  Efficiency e;
  e.variance = std::max(0.0, (state_.squares - n * squared_means) / ((n - 1) * pixels));
  const double sum = std::accumulate(differences.begin(), differences.end(), 0.0);
  const bool halves = even > 0 && odd > 0;
  e.spread = halves ? std::min(sum / pixels, e.variance) : e.variance;
  e.trimmed = halves ? std::min(trimmed_sum(std::move(differences)) / pixels, e.spread) : e.spread;
  e.doubt = sum > 0 ? squares / (sum * sum) : 0;
  e.rays = state_.rays / state_.samples + rays_of_sample;
  return e;
}

void EfficiencyRoulette::end_span() {
  const Efficiency e = measured();
  if (state_.stage == Stage::plain) {
    state_.plain = e;
    state_.stage = e.variance > well_spread * e.spread ? Stage::early_trial : Stage::trial;
  } else if (state_.stage == Stage::early_trial) {
    state_.tried = e;
    state_.stage = e.expense() < state_.plain.expense() ? Stage::early : Stage::ended;
  } else if (state_.stage == Stage::trial) {
    state_.tried = e;
    const double doubt = std::sqrt(state_.plain.doubt + e.doubt);
    const bool pays = e.expense() < state_.plain.expense() * (1 + doubt);
    state_.stage = pays ? Stage::stays : Stage::ended;
  }
  if (state_.stage == Stage::stays) state_.span *= 2;
  // Without noise, or where no light was found, there is nothing to gain.
  if (!(e.spread > 0)) state_.stage = Stage::ended;
  state_.for_survival =
      static_cast<float>(std::sqrt(e.rays / std::max(e.trimmed, e.spread * least_trimmed)));
  state_.for_splitting = static_cast<float>(std::sqrt(e.rays / e.variance));
  if (!active()) state_.for_survival = state_.for_splitting = 0;
  state_.iterations = {};
  state_.squares = state_.rays = state_.samples = 0;
  for (auto& half : sums_) std::fill(half.begin(), half.end(), 0.0);
}

std::vector<std::pair<std::string, double>> EfficiencyRoulette::statistics() const {
  return {{"roulette_spread",
           state_.plain.spread > 0 ? state_.plain.variance / state_.plain.spread : 1.0},
          {"roulette_tried", state_.tried.rays > 0 ? 1.0 : 0.0},
          {"roulette_stays", state_.stage == Stage::stays ? 1.0 : 0.0},
          {"roulette_early", state_.stage == Stage::early ? 1.0 : 0.0},
          {"roulette_expense", state_.tried.rays > 0 && state_.plain.expense() > 0
                                   ? state_.tried.expense() / state_.plain.expense()
                                   : 1.0}};
}

void EfficiencyRoulette::save(ByteWriter& out) const {
  moments_.save(out);
  out.put(state_);
  for (const auto& half : sums_) out.put(half);
}

void EfficiencyRoulette::load(ByteReader& in) {
  moments_.load(in);
  state_ = in.get<State>();
  const auto positive = [](double x) { return std::isfinite(x) && x >= 0; };
  bool good = state_.stage <= Stage::early &&
              state_.iterations[0] + state_.iterations[1] < state_.span &&
              positive(state_.squares) && positive(state_.rays) && positive(state_.samples) &&
              state_.span > 0 && positive(double(state_.for_survival)) &&
              positive(double(state_.for_splitting));
  for (auto& half : sums_) {
    half = in.get_vector<double>();
    good = good && half.size() == pixels_;
    for (const double x : half) good = good && std::isfinite(x);
  }
  if (!good) throw std::runtime_error("saved roulette is not valid");
}

}  // namespace lacuna
