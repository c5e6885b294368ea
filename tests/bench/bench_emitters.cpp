// Nanoseconds of one choice of an emitter, by power and by the light tree, and of the probability
// of a given one: `bench_emitters N`, with N emitters in a box.

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>

#include "renderer/core/alias_table.h"
#include "renderer/emitters/light_tree.h"

namespace {

using namespace lacuna;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

V3f place(Rng& rng) {
  const V2f a = rng.next2();
  return {100 * a.x, 100 * a.y, 10 * rng.next()};
}

std::vector<TreeEmitter> lamps(std::uint32_t n) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  std::vector<TreeEmitter> emitters(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    TreeEmitter& e = emitters[i];
    e.entry = i;
    const V3f x = place(rng);
    e.bounds.box.add(x);
    e.bounds.box.add(x + V3f(0.01F));
    e.bounds.axes = {V3d(place(rng) - V3f(50, 50, 5)).normalized(), 0};
    e.bounds.reach = std::numbers::pi / 2;
    e.bounds.intensity = 1 + rng.next_choice();
  }
  return emitters;
}

/// Nanoseconds of CPU time of each of `n` calls, least of some rounds.
template <class Body>
double nanoseconds(std::size_t n, Body&& body) {
  double best = 1e30;
  for (int round = 0; round < 20; ++round) {
    const double begin = cpu_seconds();
    body();
    best = std::min(best, (cpu_seconds() - begin) * 1e9 / static_cast<double>(n));
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const auto n = static_cast<std::uint32_t>(argc > 1 ? std::atoll(argv[1]) : 10000);
  const auto emitters = lamps(n);
  double begin = cpu_seconds();
  const LightTree tree(emitters);
  const double building = cpu_seconds() - begin;
  std::vector<double> powers;
  for (const TreeEmitter& e : emitters) powers.push_back(e.bounds.intensity);
  const AliasTable table(powers);

  // Batches of neighbours, as the walk makes them.
  constexpr std::size_t batch = 64, batches = 2000;
  Rng rng(2, 0, 0, Rng::Purpose::test);
  std::vector<LightTree::Request> requests(batch * batches);
  std::vector<Rng> rngs;
  for (std::size_t i = 0; i < requests.size(); ++i) rngs.emplace_back(3, 0, i, Rng::Purpose::test);
  V3f corner(0, 0, 0);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (i % batch == 0) corner = place(rng);
    const V3f normal(place(rng) - V3f(50, 50, 5));
    requests[i] = {.at = {corner + 0.01F * place(rng), normal.normalized(), false, 0.06F},
                   .u = rng.next_choice(),
                   .rng = &rngs[i]};
  }
  const double together = nanoseconds(requests.size(), [&] {
    for (std::size_t b = 0; b < batches; ++b) {
      tree.choose(std::span(requests).subspan(b * batch, batch));
    }
  });
  double sum = 0;
  const double alone = nanoseconds(requests.size(), [&] {
    for (auto& r : requests) sum += tree.choose(r.at, r.rng->next_choice(), *r.rng).probability;
  });
  const double stated = nanoseconds(requests.size(), [&] {
    for (auto& r : requests) sum += tree.probability(r.result.entry, r.at);
  });
  const double by_power = nanoseconds(requests.size(), [&] {
    for (auto& r : requests) sum += double(table.pmf(table.sample(*r.rng)).value);
  });
  fmt::print(
      "{} emitters: build {:.3f} s, {:.1f} MB; ns a choice: tree {:.1f} in batches, {:.1f} "
      "alone; probability {:.1f}; by power {:.1f} ({:.3g})\n",
      n, building, double(tree.bytes()) / 1e6, together, alone, stated, by_power, sum);
}
