#include "renderer/mutations/path_space.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

PathSpaceMutation::PathSpaceMutation(const PathSpaceSettings& settings, const ChainPaths& paths)
    : settings_(settings), paths_(paths), lengths_(paths) {
  for (Chain& c : chains_) {
    // The eye is the first vertex of all paths.
    const std::uint32_t eye = c.pool.take();
    c.pool[eye].v.kind = Vertex::Kind::eye;
    c.current.nodes.push_back({eye});
  }
}

void PathSpaceMutation::start(std::size_t i, Rng& rng) {
  chains_[i].rng = &rng;
  chains_[i].starting = true;
  chains_[i].kind = Kind::independent;
}

void PathSpaceMutation::propose(std::size_t i, Rng& rng) {
  Chain& c = chains_[i];
  c.rng = &rng;
  c.starting = false;
  if (rng.decide(static_cast<float>(settings_.large_steps))) {
    c.kind = Kind::independent;
  } else if (rng.decide(static_cast<float>(settings_.bidirectional))) {
    c.kind = Kind::bidirectional;
  } else if (rng.decide(static_cast<float>(settings_.lens))) {
    c.kind = Kind::lens;
  } else {
    c.kind = rng.below(2) == 0 ? Kind::eye : Kind::light;
  }
}

void PathSpaceMutation::evaluate(std::size_t n, Workspace& workspace, Counters& counters) {
  for (std::size_t i = 0; i < n; ++i) evaluate(chains_[i], workspace, counters);
}

bool PathSpaceMutation::sample_anew(const Chain& c, PathBuilder& builder) const {
  const int k = lengths_.sample(c.rng->next_choice());
  const int light = static_cast<int>(c.rng->below(static_cast<std::uint64_t>(k) + 1));
  builder.keep(c.current, 0, c.current.edge_count() + 1);
  builder.choose_eye(*c.rng);
  if (!builder.sample_from_light(light, *c.rng) || !builder.sample_from_eye(k - light, *c.rng)) {
    return false;
  }
  return light > 0 || builder.end_on_emitter();
}

long double PathSpaceMutation::independent_density(const PathMeasure& measure,
                                                   const VertexPool& pool,
                                                   const WholePath& path) const {
  const int k = path.edge_count();
  return lengths_.probability(k) / (k + 1) * measure.between(path, pool, 0, k + 1);
}

void PathSpaceMutation::set_contribution(Path& path, const Camera& camera, double scale) {
  path.state.clear();
  path.pixel_weight = 0;
  camera.splat(path.film, [&](std::uint32_t pixel, float weight) {
    path.state.pixels.push_back({pixel, path.colour * static_cast<float>(scale * double(weight))});
    path.pixel_weight += double(weight);
  });
  path.state.scalar = path.pixel_weight * scale;
}

void PathSpaceMutation::evaluate(Chain& c, Workspace& workspace, Counters& counters) const {
  workspace.stop.check(workspace.context);
  ++counters.samples;
  drop_proposal(c);
  if (c.current.edge_count() == 0) {
    c.pool[c.current.node(0).vertex].v.surface.x = workspace.measure.camera().position();
  }
  PathBuilder builder(workspace.measure, c.pool, workspace.parts, counters);
  c.pending = propose(c, builder);
  if (!c.pending) builder.abandon();
  const LightSink& light = workspace.context.light;
  if (c.pending && light) set_parts(c.proposed, c.pool, light.automaton());
}

void PathSpaceMutation::set_parts(Path& path, const VertexPool& pool,
                                  const PathAutomaton* automaton) {
  PathAutomaton::State state = 0;
  for (int i = 1; automaton != nullptr && i < path.edge_count(); ++i) {
    const PathNode& node = path.node(i);
    const PathSymbol letter =
        letter_at(pool[node.vertex].v, -path.edge(i - 1).w, path.edge(i).w, node.delta);
    state = automaton->step(state, letter, Transport::radiance);
  }
  const PathMatches matches = automaton != nullptr ? automaton->matches(state, 0) : PathMatches{0};
  for (const ChainState::Pixel& p : path.state.pixels) {
    path.state.parts.push_back(
        {p.index, static_cast<std::uint16_t>(path.edge_count()), matches, p.value});
  }
}

bool PathSpaceMutation::propose(Chain& c, PathBuilder& builder) const {
  const PathMeasure& measure = builder.measure();
  PartReplacement replacement(paths_);
  PathPerturbation perturbation(settings_);
  if (!build(c, builder, replacement, perturbation)) return false;
  if (!builder.connect(c.proposed) || !measure.evaluate(c.proposed, c.pool)) return false;
  if (c.starting) {
    const auto contribution = static_cast<double>(c.proposed.luminance /
                                                  independent_density(measure, c.pool, c.proposed));
    if (!(contribution > 0) || !std::isfinite(contribution) || !builder.visible()) return false;
    set_contribution(c.proposed, measure.camera(), contribution);
    return true;
  }
  set_contribution(c.proposed, measure.camera(), 1);
  const long double reverse =
      c.kind == Kind::independent ? independent_density(measure, c.pool, c.current) /
                                        independent_density(measure, c.pool, c.proposed)
      : c.kind == Kind::bidirectional
          ? replacement.reverse_ratio(measure, c.pool, c.current, c.proposed)
          : perturbation.reverse_ratio(measure, c.pool, c.current, c.proposed);
  const auto ratio = static_cast<double>(c.proposed.target() / c.current.target() * reverse);
  // Russian roulette of the shadow ray of a proposal that would rarely be accepted.
  const double test_probability = std::min(1.0, ratio / settings_.least_tested);
  if (!(ratio > 0) || !c.rng->decide(static_cast<float>(test_probability)) || !builder.visible()) {
    return false;
  }
  c.ratio = ratio / test_probability;
  return true;
}

bool PathSpaceMutation::build(const Chain& c, PathBuilder& builder, PartReplacement& replacement,
                              PathPerturbation& perturbation) const {
  const auto k = static_cast<std::uint64_t>(c.current.edge_count());
  switch (c.kind) {
    case Kind::independent:
      return sample_anew(c, builder);
    case Kind::bidirectional:
      return replacement.propose(c.current, builder, *c.rng);
    case Kind::lens:
      return perturbation.propose_from_eye(c.current, 0, builder, *c.rng);
    case Kind::eye:
      return perturbation.propose_from_eye(c.current, static_cast<int>(c.rng->below(k)), builder,
                                           *c.rng);
    default:
      return perturbation.propose_from_light(c.current, static_cast<int>(c.rng->below(k)) + 1,
                                             builder, *c.rng);
  }
}

void PathSpaceMutation::give_back(VertexPool& pool, const WholePath& path, const WholePath& kept) {
  const auto same = [](const PathNode& a, const PathNode& b) { return a.vertex == b.vertex; };
  const auto first = std::mismatch(path.nodes.begin(), path.nodes.end(), kept.nodes.begin(),
                                   kept.nodes.end(), same)
                         .first;
  const auto last = std::mismatch(path.nodes.rbegin(), path.nodes.rend(), kept.nodes.rbegin(),
                                  kept.nodes.rend(), same)
                        .first.base();
  for (auto n = first; n < last; ++n) pool.give_back(n->vertex);
}

void PathSpaceMutation::drop_proposal(Chain& c) {
  if (c.pending) give_back(c.pool, c.proposed, c.current);
  c.pending = false;
  c.ratio = 0;
  c.proposed.state.clear();
}

void PathSpaceMutation::accept(std::size_t i) {
  Chain& c = chains_[i];
  give_back(c.pool, c.current, c.proposed);
  std::swap(c.current, c.proposed);
  c.pending = false;
}

}  // namespace lacuna
