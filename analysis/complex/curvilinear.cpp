#include "analysis/complex/curvilinear.h"

#include "analysis/complex/pierce.h"

namespace lacuna {
namespace {

/// Adds the edges that the rule keeps in `complex` to `kept`, by a collapse of a copy.
int ask_rule(CubicalComplex complex, const SpaceMaps& maps, KeptEdges& kept, ThinningReport& report,
             const ThreadPool* pool) {
  KeepRule rule(complex, maps, kept);
  const int layers = collapse(complex, KeptEdges(complex), &rule, all_layers, pool);
  rule.finish();
  report.openings_asked += rule.openings_asked();
  return layers;
}

}  // namespace

ThinComplex thin(const BitGrid3& domain, const SpaceMaps& maps, ThinningReport& report,
                 const ThreadPool* pool) {
  CubicalComplex complex(domain);
  KeptEdges kept(complex);
  report.layers = ask_rule(complex, maps, kept, report, pool);
  report.kept_edges = kept.count();
  collapse(complex, kept, nullptr, all_layers, pool);
  return {std::move(complex), std::move(kept)};
}

CubicalComplex curvilinear_skeleton(const BitGrid3& domain, const SpaceMaps& maps,
                                    ThinningReport& report, const ThreadPool* pool,
                                    std::uint64_t byte_limit) {
  // The complex, its copy for the rule, and the data per block of both.
  const std::uint64_t block = 2 * sizeof(ComplexBlock) + collapse_bytes_per_block +
                              KeepRule::bytes_per_block + KeptEdges::bytes_per_block;
  require_memory("thinning", domain.size(), CubicalComplex::blocks_of(domain.size()) * block,
                 byte_limit);
  auto [complex, kept] = thin(domain, maps, report, pool);
  for (;;) {
    if (pool != nullptr) pool->check_stop();
    const std::vector<Square> squares = squares_to_pierce(complex, maps.distance, pool);
    if (squares.empty()) return std::move(complex);
    ++report.pierce_rounds;
    report.squares_pierced += squares.size();
    for (const Square& s : squares) complex.remove(s.cell, s.type);
    ask_rule(complex, maps, kept, report, pool);
    collapse(complex, kept, nullptr, all_layers, pool);
  }
}

}  // namespace lacuna
