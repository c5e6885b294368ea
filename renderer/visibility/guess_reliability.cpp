#include "renderer/visibility/guess_reliability.h"

#include <atomic>

#include "renderer/core/free_memory.h"

namespace lacuna {

void GuessAnswers::append(const VisibilityEstimate& d) {
  for (int k = 0; k < Lanes::groups; ++k) {
    const Float8 q = d.untested.eight(k);
    const Mask8 knows_nothing = mask_from_bits(static_cast<unsigned>(d.tests >> (8 * k) & 0xff));
    const Float8 known = keep_where(q > 0, select(q >= 1, visible, partial));
    code_.set(k, code_.eight(k) * float(answers) + select(knows_nothing, unknown, known));
  }
}

void GuessReliability::resize(std::size_t cells, std::size_t codes) {
  require_free(double(cells) * double(codes) * (2 * sizeof(Tally) + sizeof(float)), [&] {
    return fmt::format(
        "many_lights: the rates of {} answers in {} pairs of cells; lower analysis.resolution, "
        "or choose \"reliability\": \"picture\"",
        codes, cells);
  });
  codes_ = codes;
  sums_.assign(cells * codes, {});
  added_.assign(cells * codes, {});
  rates_.clear();
}

void GuessReliability::add(std::size_t cell, std::span<const Tally> tallies) {
  const auto plus = [](std::uint64_t& sum, std::uint64_t n) {
    std::atomic_ref(sum).fetch_add(n, std::memory_order_relaxed);
  };
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    if (tallies[i].tests == 0) continue;
    Tally& sum = added_[cell * codes_ + i];
    plus(sum.tests, tallies[i].tests);
    plus(sum.weights, tallies[i].weights);
    plus(sum.visible, tallies[i].visible);
  }
}

void GuessReliability::discard() { std::fill(added_.begin(), added_.end(), Tally{}); }

void GuessReliability::update() {
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += added_[i];
  discard();
  update_rates();
}

std::vector<GuessReliability::Tally> GuessReliability::totals() const {
  std::vector<Tally> total(codes_);
  for (std::size_t i = 0; i < sums_.size(); ++i) total[i % codes_] += sums_[i];
  return total;
}

void GuessReliability::update_rates() {
  const auto rate = [](const Tally& t, double prior) {
    if (t.tests == 0) return prior;
    const auto n = double(t.tests);
    return (n * t.rate() + prior_tests * prior) / (n + prior_tests);
  };
  std::vector<double> of_all;
  bool learned = false;
  for (const Tally& t : totals()) {
    of_all.push_back(rate(t, 0.5));
    learned = learned || t.tests > 0;
  }
  if (!learned) return rates_.clear();
  rates_.resize(sums_.size());
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    rates_[i] = static_cast<float>(rate(sums_[i], of_all[i % codes_]));
  }
}

void GuessReliability::load(ByteReader& in) {
  std::vector<Tally> saved = in.get_vector<Tally>();
  if (saved.size() != sums_.size()) {
    throw std::runtime_error(
        fmt::format("saved state has {} rates of guesses, not {}", saved.size(), sums_.size()));
  }
  sums_ = std::move(saved);
  update_rates();
}

}  // namespace lacuna
