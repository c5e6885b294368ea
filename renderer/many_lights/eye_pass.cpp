#include "renderer/many_lights/eye_pass.h"

namespace lacuna {

void VplEyePass::trace(const Tile& tile, const Image& image) {
  memory_.shaded.fill(0);
  start_paths(context_, image, tile, batch_);
  if (setting_.first) counters_.samples += batch_.states.size();
  trace_paths();
  find_points();
}

/// Adds emission or direct light, of a path of `edges` edges, to the pixel of path `i`.
void VplEyePass::contribute(std::size_t i, int edges, const Rgb& value) {
  batch_.radiance[i] += value;
  if (setting_.first) context_.light.add(batch_.pixels[i], edges, 0, value);
}

void VplEyePass::trace_paths() {
  Walk walk(context_.scene, setting_.guide,
            {.max_depth = settings_.max_depth,
             .roulette_depth = settings_.roulette_depth,
             .packets = true},
            counters_);
  walk.trace_paths(
      batch_.states, [this](std::size_t i, int depth) { return visit(i, depth); }, selection_);
  if (!setting_.first) {
    memory_.shadows = {};
    batch_.radiance.fill(Rgb(0, 0, 0));
    return;
  }
  memory_.shadows.flush(context_.scene.rays(), counters_,
                        [&](const Memory::Direct& d) { contribute(d.path, d.edges, d.value); });
}

/// Visits a vertex of eye path `i`; false if the path ends.
bool VplEyePass::visit(std::size_t i, int depth) {
  Vertex& v = batch_.vertex(i, depth);
  const bool first = memory_.shaded[i] == 0;
  const Vertex& before = batch_.vertex(i, depth - 1);
  // Virtual lights also sample this edge, except for the part above the bound.
  const bool shared = !first && depth == memory_.shaded[i] + 1 && !before.delta;
  if (shared && by_lights()) {
    contribute(i, depth, emitted(v) * missing(before, v));
  } else {
    contribute(i, depth, direct_.hit(v, before, depth));
  }
  if (v.kind != Vertex::Kind::surface || depth == settings_.max_depth) return false;
  const bool lit_by_lights = v.bsdf->is_vpl_receiver(setting_.least_alpha);
  if (!first && !settings_.compensation) return false;
  if (first && lit_by_lights) {
    memory_.shaded[i] = depth;
    if (!setting_.first) return false;
  } else if (shared && lit_by_lights) {
    const float weight = missing(before, v);
    if (weight == 0) return false;
    v.throughput *= weight;
    batch_.states[i].throughput *= weight;
  }
  if (v.bsdf->connectible() && direct_.active() && !(first && lit_by_lights && by_lights())) {
    direct_.sample(v, depth, selection_.of(i), batch_.states[i].rng,
                   [&](const Ray& ray, const Rgb& value, const DirectLight::Sample&) {
                     memory_.shadows.add(ray, {value, static_cast<std::uint32_t>(i), depth + 1});
                   });
  }
  return settings_.compensation || !by_lights() || !lit_by_lights;
}

/// The share of the light from `to` that the bound of the geometric term removes.
float VplEyePass::missing(const Vertex& at, const Vertex& to) const {
  if (to.kind == Vertex::Kind::background) return 0;
  return 1 - setting_.terms.share(at, to, to.wp);
}

Rgb VplEyePass::emitted(const Vertex& v) const {
  const std::optional<EmitterPoint> e = emitter_at(context_.scene, v);
  return e ? v.throughput * e->emission : Rgb(0, 0, 0);
}

void VplEyePass::find_points() {
  memory_.points.clear();
  memory_.paths.clear();
  for (std::size_t i = 0; i < batch_.states.size(); ++i) {
    const int depth = memory_.shaded[i];
    if (depth == 0 || depth >= settings_.max_depth) continue;
    memory_.points.emplace_back(batch_.vertex(i, depth), depth, settings_.max_depth - 1 - depth,
                                batch_.pixels[i]);
    memory_.paths.push_back(i);
  }
}

}  // namespace lacuna
