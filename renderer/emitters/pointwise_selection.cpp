#include "renderer/emitters/pointwise_selection.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

PointwiseSelection::PointwiseSelection(const std::vector<TreeEmitter>& finite,
                                       std::span<const Infinite> infinite, double power,
                                       double extent, const AliasTable& by_power)
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
    infinite_share_ = std::round(std::clamp(sum / power, 0.125, 0.875) * 0x1p32) * 0x1p-32;
  }
  tree_ = LightTree(finite, extent);
}

namespace {

double unit(const Rng::FinePoint& at) { return static_cast<double>(at.x >> 11) * 0x1p-53; }

}  // namespace

PointwiseSelection::Choice PointwiseSelection::choose_infinite(Rng::FinePoint at, Rng& rng) const {
  at.u_select = infinite_.size() > 1 ? rng.next_u32() : 0;  // it has been used to select infinity
  const std::uint32_t i = infinite_.sample(at);
  const std::uint32_t entry = infinite_entries_[i];
  return {entry, relative(entry, infinite_share_ * double(infinite_.pmf(i).value)), at};
}

PointwiseSelection::Choice PointwiseSelection::choose_finite(const LightTree::Choice& c,
                                                             Rng::FinePoint at) const {
  at.x = static_cast<std::uint64_t>(c.rest * 0x1p64);
  return {c.entry, relative(c.entry, (1 - infinite_share_) * c.probability), at};
}

PointwiseSelection::Choice PointwiseSelection::choose(const Receiver& receiver,
                                                      const Rng::FinePoint& at, Rng& rng) const {
  if (goes_to_infinity(at)) return choose_infinite(at, rng);
  return choose_finite(tree_.choose(receiver, unit(at), rng), at);
}

void PointwiseSelection::choose(std::span<Request> requests) const {
  constexpr std::size_t together = 64;
  std::array<LightTree::Request, together> descents;
  std::array<Request*, together> tree_requests{};
  std::array<Rng::FinePoint, together> numbers;
  std::size_t n = 0;
  const auto descend = [&] {
    tree_.choose(std::span(descents).first(n));
    for (std::size_t k = 0; k < n; ++k) {
      by_power_.prefetch(descents[k].result.entry);
    }
    for (std::size_t k = 0; k < n; ++k) {
      tree_requests[k]->result = choose_finite(descents[k].result, numbers[k]);
    }
    n = 0;
  };
  for (Request& r : requests) {
    const Rng::FinePoint at = r.rng->next_fine_point();
    if (goes_to_infinity(at)) {
      r.result = choose_infinite(at, *r.rng);
      continue;
    }
    descents[n].at = r.receiver;
    descents[n].u = unit(at);
    descents[n].rng = r.rng;
    numbers[n] = at;
    tree_requests[n++] = &r;
    if (n == together) descend();
  }
  descend();
}

float PointwiseSelection::ratio(std::uint32_t entry, const Receiver& at) const {
  const double p = tree_.probability(entry, at);
  if (p > 0) return relative(entry, (1 - infinite_share_) * p);
  const auto found = std::find(infinite_entries_.begin(), infinite_entries_.end(), entry);
  if (found == infinite_entries_.end()) return 0;
  const auto i = static_cast<std::uint32_t>(found - infinite_entries_.begin());
  return relative(entry, infinite_share_ * double(infinite_.pmf(i).value));
}

}  // namespace lacuna
