#include "renderer/path/light_batch.h"

#include <utility>

namespace lacuna {

LightBatch::LightBatch(const LightPathSetting& setting, const Guide& guide)
    : setting_(setting),
      guide_(guide),
      places_(static_cast<std::size_t>(setting.max_depth)),
      next_event_(setting.scene, setting.next_event),
      vertices_(places_ * size),
      hits_(places_ * size) {
  states_.reserve(size);
}

void LightBatch::walk(std::span<const Rng> rngs, Counters& counters,
                      std::span<const std::uint32_t> choices, std::span<const int> wanted) {
  clear();
  const auto goes_on = [&](std::size_t i, int vertices) {
    return vertices < (wanted.empty() ? setting_.max_depth : wanted[i]);
  };
  states_.clear();
  counters.samples += rngs.size();
  for (std::size_t i = 0; i < rngs.size(); ++i) {
    Rng rng = rngs[i];
    Rng::FinePoint at = rng.next_fine_point();
    lens_[i] = setting_.camera.lens_numbers(rng);
    if (!choices.empty()) at.x = std::uint64_t{choices[i]} << 32 | (at.x & 0xffffffff);
    if (start(i, at) && goes_on(i, 1)) start_walk(i, rng);
  }
  const WalkLimits limits{.max_depth = setting_.max_depth - 1,
                          .last_scatters = true,
                          .roulette_depth = setting_.roulette_depth,
                          .transport = Transport::importance,
                          .counts = light_side(setting_.counts),
                          .letters = setting_.letters};
  Walk walk(setting_.scene, guide_, limits, counters);
  walk.trace_paths(states_, [&](std::size_t i, int depth) {
    const std::size_t path = path_of_[i];
    if (vertex(path, depth).kind == Vertex::Kind::surface) length_[path] = depth + 1;
    if (depth == 1) set_ratio(path);
    hits_[path * places_ + static_cast<std::size_t>(depth)] = walk.hit(i);
    return goes_on(path, depth + 1);
  });
  trace_branches(walk);
}

void LightBatch::clear() {
  branches_.clear();
  for (auto& of_path : branches_of_) of_path.clear();
}

void LightBatch::restore(std::size_t i, std::span<const Photon> photons,
                         std::span<const Hit> hits) {
  length_[i] = 1;
  std::size_t path = i;
  for (std::size_t k = 0; k < photons.size(); ++k) {
    const Photon& p = photons[k];
    if (k > 0 && p.index <= photons[k - 1].index) path = add_branch(i, p.index);
    Vertex& v = append(path, p.index);
    v.kind = Vertex::Kind::surface;
    v.delta = false;
    v.surface = setting_.scene.surface(hits[k], p.x);
    v.wp = p.wp;
    v.throughput = p.throughput;
    v.p_fwd = Pdf<Area>(p.p_fwd);
    v.prev_connectible = p.prev_connectible;
    v.mis_partial = p.mis_partial;
    v.letters = p.letters;
    setting_.scene.make_bsdf(v.surface, v.bsdf);
    guide_.on_hit(v);
  }
}

void LightBatch::splat(std::size_t paths, Counters& counters, Splats& splats) {
  const auto add = [&](std::size_t j, int index) {
    connect_to_eye(j, index, [&](const Ray& ray, UnshadowedSplat splat) {
      if (setting_.observer != nullptr) splat.traced = observe(j, index, ray, splat);
      queue_.add(ray, splat);
    });
  };
  for (std::size_t i = 0; i < paths; ++i) {
    if (length_[i] > 0) add(i, 0);
    for_each_vertex(i, add);
  }
  queue_.flush(setting_.scene.rays(), counters, [&](const UnshadowedSplat& p) {
    if (p.traced != 0) setting_.observer->arrived(p.traced);
    setting_.camera.splat(p.at, [&](std::uint32_t pixel, float share) {
      splats.push_back({p.value * share, p.weight, pixel, p.s, p.matches});
    });
  });
}

std::vector<const Vertex*> LightBatch::path_to(std::size_t i, int last) const {
  std::vector<const Vertex*> path;
  for (int index = 0; index <= last; ++index) path.push_back(&vertex(i, index));
  return path;
}

[[gnu::cold]] std::uint32_t LightBatch::observe(std::size_t i, int last, const Ray& ray,
                                                const UnshadowedSplat& splat) const {
  float share = 0;
  setting_.camera.splat(splat.at, [&](std::uint32_t pixel, float of_pixel) {
    if (setting_.observer->watches(pixel)) share += of_pixel;
  });
  if (share == 0) return 0;
  Vertex eye;
  eye.surface.x = ray.o;
  const std::array<const Vertex*, 1> from_eye{&eye};
  return setting_.observer->add({.iteration = setting_.iteration,
                                 .s = last + 1,
                                 .t = 1,
                                 .value = splat.value * (splat.weight * share),
                                 .weight = splat.weight},
                                from_eye, path_to(i, last));
}

std::size_t LightBatch::add_branch(std::size_t parent, int first) {
  const std::size_t i = size + branches_.size();
  const std::size_t origin = parent < size ? parent : branch(parent).origin;
  branches_of_[origin].push_back(i);
  branches_.push_back({parent, origin, first, first, {}, {}});
  return i;
}

Vertex& LightBatch::append(std::size_t i, int index) {
  if (i < size) {
    while (length_[i] <= index) vertex_to_set(i, length_[i]++).bsdf.reset();
    return vertex_to_set(i, index);
  }
  Branch& b = branches_[i - size];
  b.length = index + 1;
  b.vertices.resize(static_cast<std::size_t>(b.length + 1 - b.first));
  return b.vertices.back();
}

void LightBatch::trace_branches(Walk& walk) {
  std::vector<std::pair<std::size_t, PathBranch>> pending;  // with the path that was split
  for (;;) {
    for (PathBranch& b : walk.branches()) pending.emplace_back(path_of_[b.walk], std::move(b));
    walk.branches().clear();
    if (pending.empty()) return;
    traced_.resize(places_ * size);
    traced_hits_.resize(places_ * size);
    states_.clear();
    for (; !pending.empty() && states_.size() < size; pending.pop_back()) {
      auto& [parent, b] = pending.back();
      b.state.path = std::span(traced_).subspan(states_.size() * places_, places_);
      b.state.path[static_cast<std::size_t>(b.state.depth)] = std::move(b.vertex);
      path_of_[states_.size()] = add_branch(parent, b.state.depth + 1);
      states_.push_back(b.state);
    }
    walk.trace_paths(states_, [&](std::size_t k, int depth) {
      const auto at = static_cast<std::size_t>(depth);
      if (states_[k].path[at].kind == Vertex::Kind::surface) {
        branches_[path_of_[k] - size].length = depth + 1;
      }
      traced_hits_[k * places_ + at] = walk.hit(k);
    });
    for (std::size_t k = 0; k < states_.size(); ++k) {
      Branch& b = branches_[path_of_[k] - size];
      const auto begin = static_cast<std::ptrdiff_t>(k * places_) + b.first - 1;
      const auto end = static_cast<std::ptrdiff_t>(k * places_) + b.length;
      b.vertices.assign(traced_.begin() + begin, traced_.begin() + end);
      b.hits.assign(traced_hits_.begin() + begin, traced_hits_.begin() + end);
    }
  }
}

void LightBatch::set_ratio(std::size_t i) {
  if (length_[i] < 2 || !(setting_.counts.nee > 0)) return;
  Vertex& v = vertex_to_set(i, 1);
  if (v.connectible()) v.next_event_ratio = next_event_.ratio(emitters_[i], v);
}

bool LightBatch::start(std::size_t i, const Rng::FinePoint& at) {
  const EmitterSet& lights = setting_.scene.emitters();
  length_[i] = lights.empty() ? 0 : 1;
  if (!lights.empty()) emitters_[i] = lights.sample(lights.choose(at));
  if (!lights.empty() && setting_.observer != nullptr) place(i);
  return !lights.empty();
}

void LightBatch::place(std::size_t i) {
  Vertex& v = vertex_to_set(i, 0);
  place_on(emitters_[i], v);
  v.p_fwd = emitters_[i].pdf;
}

void LightBatch::start_walk(std::size_t i, Rng& rng) {
  const EmitterPoint& e = emitters_[i];
  const std::optional<LightLeSample> le = guide_.sample_Le(setting_.scene.emitters(), e, rng);
  if (!le) return;
  const std::span<Vertex> path = std::span(vertices_).subspan(i * places_, places_);
  place_on(e, path[0]);
  PathState w{.rng = rng, .ray = le->ray, .p = le->pdf, .path = path};
  w.throughput = le->throughput;
  w.roulette.carried_before = 1 / max_component(le->throughput);
  if (!e.delta()) w.mis_partial = light_side(setting_.counts).none / double(e.pdf.value);
  path_of_[states_.size()] = i;
  states_.push_back(w);
}

}  // namespace lacuna
