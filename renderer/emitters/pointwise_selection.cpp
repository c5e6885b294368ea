#include "renderer/emitters/pointwise_selection.h"

#include <algorithm>

namespace lacuna {

PointwiseSelection::PointwiseSelection(std::vector<TreeEmitter> finite,
                                       std::span<const Infinite> infinite, double power,
                                       const AliasTable& by_power)
    : by_power_(by_power), finite_(finite.size()) {
  std::vector<double> powers;
  double sum = 0;
  for (const Infinite& i : infinite) {
    infinite_entries_.push_back(i.entry);
    powers.push_back(i.power);
    sum += i.power;
  }
  infinite_ = AliasTable(powers);
  if (finite.empty()) {
    infinite_share_ = 1;
  } else if (!infinite.empty()) {
    infinite_share_ = std::clamp(sum / power, 0.125, 0.875);
  }
  tree_ = LightTree(std::move(finite));
}

PointwiseSelection::Choice PointwiseSelection::choose_infinite(Rng& rng) const {
  const AliasTable::Draw d = infinite_.resolve(infinite_.choose(rng), rng);
  return relative(infinite_entries_[d.index], infinite_share_ * double(d.pmf.value));
}

PointwiseSelection::Choice PointwiseSelection::choose(const Receiver& at, Rng& rng) const {
  if (goes_to_infinity(rng)) return choose_infinite(rng);
  const LightTree::Choice c = tree_.choose(at, rng);
  return relative(c.entry, (1 - infinite_share_) * c.probability);
}

void PointwiseSelection::choose(std::span<Request> requests) const {
  constexpr std::size_t together = 16;
  std::array<LightTree::Request, together> descents;
  std::array<Request*, together> asked{};
  std::size_t n = 0;
  const auto descend = [&] {
    tree_.choose(std::span(descents).first(n));
    for (std::size_t k = 0; k < n; ++k) {
      const LightTree::Choice& c = descents[k].result;
      by_power_.prefetch(c.entry);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const LightTree::Choice& c = descents[k].result;
      asked[k]->result = relative(c.entry, (1 - infinite_share_) * c.probability);
    }
    n = 0;
  };
  for (Request& r : requests) {
    if (goes_to_infinity(*r.rng)) {
      r.result = choose_infinite(*r.rng);
      continue;
    }
    descents[n] = {r.at, r.rng, {}};
    asked[n++] = &r;
    if (n == together) descend();
  }
  descend();
}

float PointwiseSelection::ratio(std::uint32_t entry, const Receiver& at) const {
  const double p = tree_.probability(entry, at);
  if (p > 0) return relative(entry, (1 - infinite_share_) * p).ratio;
  const auto found = std::find(infinite_entries_.begin(), infinite_entries_.end(), entry);
  if (found == infinite_entries_.end()) return 0;
  const auto i = static_cast<std::uint32_t>(found - infinite_entries_.begin());
  return relative(entry, infinite_share_ * double(infinite_.pmf(i).value)).ratio;
}

}  // namespace lacuna
