#include "renderer/path/walk.h"

#include <algorithm>
#include <array>

#include "renderer/path/path_letters.h"

namespace lacuna {

std::optional<BsdfSample> Walk::sample(const Vertex& v, Rng& rng) const {
  return guide_.sample(v, rng, limits_.transport);
}

void Walk::trace(PathState& w, Hit& hit) {
  ++counters_.rays;
  const bool is_hit = scene_.rays().intersect(w.ray, hit);
  vertex(w, w.depth).kind = is_hit ? Vertex::Kind::surface : Vertex::Kind::background;
  if (is_hit) scene_.prefetch(hit);
}

void Walk::trace_first(std::span<PathState> states) {
  constexpr std::size_t together = 8;
  std::array<Ray, together> rays;
  std::array<std::uint8_t, together> is_hit{};
  counters_.rays += states.size();
  for (std::size_t first = 0; first < states.size(); first += together) {
    const std::span<PathState> some =
        states.subspan(first, std::min(together, states.size() - first));
    for (std::size_t k = 0; k < some.size(); ++k) rays[k] = some[k].ray;
    const std::span<Hit> hits = std::span(hits_).subspan(first, some.size());
    scene_.rays().intersect(std::span(rays).first(some.size()), hits, is_hit);
    for (std::size_t k = 0; k < some.size(); ++k) {
      vertex(some[k], 1).kind = is_hit[k] != 0 ? Vertex::Kind::surface : Vertex::Kind::background;
      if (is_hit[k] == 0) continue;
      scene_.prefetch(hits[k]);
    }
  }
}

// Flattened: called at every vertex, and GCC does not inline all of it by itself.
[[gnu::flatten]] void Walk::on_hit(PathState& w, const Hit& hit) {
  const int depth = w.depth;
  Vertex& v = vertex(w, depth);
  v.delta = false;
  v.next_event_ratio = 1;
  v.wp = -w.ray.d;
  v.throughput = w.throughput;
  if (v.kind == Vertex::Kind::background) {
    v.surface.x = w.ray.d;
  } else {
    v.surface = scene_.surface(w.ray, hit);
    if (scatters(depth)) {
      scene_.prefetch_bsdf(v.surface);
      guide_.prefetch(v);
    }
  }
  const Vertex& before = vertex(w, depth - 1);
  if (scene_.has_media()) absorb(w, before, v);
  v.p_fwd = to_area(w.p, before, w.ray.d, v);
  if (w.mis_partial > 0) {
    v.mis_partial = w.mis_partial * double(to_area(Pdf<SolidAngle>(1.0F), v, v.wp, before).value);
  } else {
    v.mis_partial = 0;
  }
  v.prev_connectible = before.connectible();
  if (limits_.letters != nullptr) [[unlikely]]
    read_letter(before, w.ray.d, v);
}

[[gnu::noinline, gnu::cold]] void Walk::read_letter(const Vertex& before, const V3f& wi,
                                                    Vertex& v) const {
  v.letters = 0;
  if (before.kind != Vertex::Kind::surface) return;
  const bool from_eye = limits_.transport == Transport::radiance;
  const PathSymbol letter =
      letter_at(before, from_eye ? before.wp : wi, from_eye ? wi : before.wp, before.delta);
  v.letters = limits_.letters->step(before.letters, letter, limits_.transport);
}

// Not inline: on_hit() is flattened, and few scenes absorb.
[[gnu::noinline, gnu::cold]] void Walk::absorb(PathState& w, const Vertex& before,
                                               Vertex& v) const {
  // Emitters at infinity: their light comes from there. The eye of a parallel projection does not.
  const bool from_infinity =
      before.kind == Vertex::Kind::background && limits_.transport == Transport::importance;
  const bool infinite = from_infinity || v.kind == Vertex::Kind::background;
  const auto medium = [&](const Vertex& at, const V3f& along) {
    return at.kind == Vertex::Kind::surface ? scene_.medium(at.surface, along) : nullptr;
  };
  w.throughput *= transmittance(medium(before, w.ray.d), medium(v, v.wp),
                                infinite ? infinite_distance : (v.surface.x - w.ray.o).length());
  v.throughput = w.throughput;
}

void Walk::scatter(PathState& w, int depth) {
  Vertex& v = vertex(w, depth);
  if (v.kind == Vertex::Kind::background || !scatters(depth)) return;
  scene_.make_bsdf(v.surface, v.bsdf);
  guide_.on_hit(v);
}

bool Walk::continues(PathState& w, std::size_t walk) {
  const Vertex& v = vertex(w, w.depth);
  if (v.kind == Vertex::Kind::background || w.depth == limits_.max_depth) return false;
  const int parts = roulette_.parts(w, v);
  if (parts > 1) split(w, v, parts, walk);
  return parts > 0;
}

void Walk::split(PathState& w, const Vertex& v, int parts, std::size_t walk) {
  const float share = 1.0F / static_cast<float>(parts);
  w.throughput *= share;
  w.roulette.scale *= static_cast<float>(parts);
  for (int k = 1; k < parts; ++k) {
    PathBranch& b = branches_.emplace_back();
    b.state = w;
    b.state.rng = w.rng.branch();
    b.state.roulette.split = 1;
    b.vertex = v;
    b.vertex.throughput *= share;
    b.walk = walk;
  }
  w.roulette.split *= static_cast<float>(parts);
}

[[gnu::flatten]] bool Walk::sample_next(PathState& w) {
  const int depth = w.depth;
  Vertex& v = vertex(w, depth);
  w.rng.next_vertex();
  const std::optional<BsdfSample> next = sample(v, w.rng);
  if (!next) return false;
  w.throughput *= next->weight;
  w.roulette.scale *= next->pdf_ratio;
  if (!roulette_.survives(w)) return false;
  v.delta = next->delta;
  // The delta functions cancel in all ratios of densities: both walks use density 1 instead.
  w.p = next->delta ? Pdf<SolidAngle>(1.0F) : next->pdf;
  if (tracked_) w.mis_partial = mis_partial(v, depth, next->wi);
  w.ray = {offset_origin(v.surface.x, v.surface.ng, v.surface.offset, next->wi), next->wi};
  return true;
}

double Walk::mis_partial(const Vertex& v, int depth, const V3f& wi) const {
  const bool connectible = v.prev_connectible && v.connectible();
  double pdf_rev = 0;
  if (v.mis_partial > 0) {
    const Transport other =
        limits_.transport == Transport::radiance ? Transport::importance : Transport::radiance;
    pdf_rev = v.delta ? 1.0 : double(guide_.pdf(v, wi, v.wp, other).value);
  }
  const TechniqueCounts counts = limits_.counts.with_one(double(v.next_event_ratio));
  return (mis_partial_sum(counts, depth, connectible, pdf_rev, v.mis_partial) +
          merge_partial(limits_.counts, depth, v.connectible(), double(v.p_fwd.value))) /
         double(v.p_fwd.value);
}

}  // namespace lacuna
