#include "renderer/mutations/path_builder.h"

#include <algorithm>

#include "renderer/path/connect.h"

namespace lacuna {

namespace {

/// The position of a vertex of a path, or of its start point on an emitter.
struct NodePlace {
  const PathVertex& p;

  bool infinite() const { return VertexPlace{p.v}.infinite(); }
  const V3f& x() const { return p.v.surface.x; }
  V3f origin(const V3f& w) const {
    return p.v.kind == Vertex::Kind::emitter ? p.emitter.origin(w) : VertexPlace{p.v}.origin(w);
  }
  V3f end(const V3f& w, float distance) const {
    if (p.v.kind == Vertex::Kind::emitter) return p.emitter.end(w, distance);
    return VertexPlace{p.v}.end(w, distance);
  }
};

}  // namespace

void PathBuilder::keep(const WholePath& path, int first, int last) {
  keep_eye(path, first);
  keep_light(path, last);
}

void PathBuilder::keep_eye(const WholePath& path, int first) {
  for (std::size_t i = kept_eye_; i < eye_.size(); ++i) pool_.give_back(eye_[i].vertex);
  eye_.assign(path.nodes.begin(), path.nodes.begin() + first + 1);
  kept_eye_ = eye_.size();
  if (measure_.camera().parallel() && first == 0) renew_eye(measure_.camera().position());
}

void PathBuilder::renew_eye(const V3f& x) {
  eye_.assign(1, {pool_.take(), false, false});
  kept_eye_ = 0;
  Vertex& v = pool_[eye_.front().vertex].v;
  v = Vertex{};
  v.surface.x = x;
}

void PathBuilder::choose_eye(Rng& rng) {
  const Camera& camera = measure_.camera();
  if (camera.has_lens()) renew_eye(camera.eye(camera.position(), rng.next2()));
}

void PathBuilder::keep_light(const WholePath& path, int last) {
  light_.assign(path.nodes.rbegin(), path.nodes.rend() - last);
  kept_light_ = light_.size();
}

bool PathBuilder::sample_from_eye(int n, Rng& rng) {
  for (int i = 0; i < n; ++i) {
    const bool is_hit = eye_.size() == 1 ? look_through(measure_.film_point(rng.next2()))
                                         : scatter(eye_, Transport::radiance, rng);
    if (!is_hit) return false;
  }
  return true;
}

bool PathBuilder::sample_from_light(int n, Rng& rng) {
  for (int i = 0; i < n; ++i) {
    bool is_hit = false;
    if (light_.empty()) {
      is_hit = start_light(rng);
    } else if (light_.size() == 1) {
      is_hit = leave_light(rng);
    } else {
      is_hit = scatter(light_, Transport::importance, rng);
    }
    if (!is_hit) return false;
  }
  return true;
}

bool PathBuilder::look_through(const V2f& at) {
  V3f& x = pool_[eye_.front().vertex].v.surface.x;
  const Ray ray = measure_.camera().ray(at.x, at.y, x);
  if (measure_.camera().parallel()) x = ray.o;
  return arrive(ray, eye_);
}

bool PathBuilder::arrive(const Ray& ray, std::vector<PathNode>& end) {
  const Scene& scene = measure_.scene();
  ++counters_.rays;
  Hit hit;
  const bool is_hit = scene.rays().intersect(ray, hit);
  if (!is_hit && &end == &light_) return false;
  const std::uint32_t id = pool_.take();
  end.push_back({id, false, false});
  Vertex& v = pool_[id].v;
  v.wp = -ray.d;
  if (is_hit) {
    v.kind = Vertex::Kind::surface;
    v.surface = scene.surface(ray, hit);
    scene.make_bsdf(v.surface, v.bsdf);
  } else {
    v.kind = Vertex::Kind::background;
    v.surface.x = ray.d;
    v.bsdf.reset();
  }
  return true;
}

bool PathBuilder::scatter(std::vector<PathNode>& end, Transport transport, Rng& rng) {
  PathNode& node = end.back();
  const Vertex& v = vertex(node);
  if (v.kind != Vertex::Kind::surface) return false;
  const V3f from = edge_between(VertexPlace{v}, VertexPlace{vertex(end[end.size() - 2])}).w;
  const auto [u_lobe, u] = rng.next_choice_and_point();
  const auto next = v.bsdf->sample(from, u_lobe, u, transport);
  if (!next) return false;
  node.delta = next->delta;
  node.transmitted = next->transmitted;
  return arrive({VertexPlace{v}.origin(next->wi), next->wi}, end);
}

bool PathBuilder::start_light(Rng& rng) {
  const EmitterSet& emitters = measure_.scene().emitters();
  if (emitters.empty()) return false;
  const std::uint32_t id = pool_.take();
  light_.push_back({id, false, false});
  PathVertex& p = pool_[id];
  p.emitter = emitters.sample(emitters.choose(rng));
  place_on(p.emitter, p.v);
  p.v.bsdf.reset();
  return true;
}

bool PathBuilder::leave_light(Rng& rng) {
  const auto le = measure_.scene().emitters().sample_Le(pool_[light_.front().vertex].emitter, rng);
  return le && arrive(le->ray, light_);
}

bool PathBuilder::go_from_eye(const V3f& w) {
  eye_.back().delta = false;
  return arrive({VertexPlace{vertex(eye_.back())}.origin(w), w}, eye_);
}

bool PathBuilder::go_from_light(const V3f& w) {
  light_.back().delta = false;
  return arrive({NodePlace{pool_[light_.back().vertex]}.origin(w), w}, light_);
}

bool PathBuilder::enter_scene(const V3f& at, const V3f& w) {
  light_.back().delta = false;
  // Starts this far before the surface point, so that the ray begins outside the scene by its
  // radius.
  const double back = 3 * measure_.scene().bounds().radius();
  return arrive({V3f(V3d(at) - V3d(w) * back), w}, light_);
}

bool PathBuilder::follow_from_eye(bool transmitted) {
  PathNode& node = eye_.back();
  const Vertex& v = vertex(node);
  if (v.kind != Vertex::Kind::surface) return false;
  const auto lobe = v.bsdf->delta(v.wp, transmitted);
  if (!lobe) return false;
  node.delta = true;
  node.transmitted = transmitted;
  return arrive({VertexPlace{v}.origin(lobe->wi), lobe->wi}, eye_);
}

bool PathBuilder::follow_from_light(bool transmitted) {
  PathNode& node = light_.back();
  const Vertex& v = vertex(node);
  const auto lobe = v.bsdf->delta(v.wp, transmitted);
  if (!lobe) return false;
  // Eye and light may see the surface with different normals; then this lobe is invisible to the
  // eye.
  const auto seen = v.bsdf->delta(lobe->wi, transmitted);
  if (!seen || (seen->wi - v.wp).length2() > 1e-6F) return false;
  node.delta = true;
  node.transmitted = transmitted;
  return arrive({VertexPlace{v}.origin(lobe->wi), lobe->wi}, light_);
}

bool PathBuilder::end_on_emitter() {
  PathVertex& last = pool_[eye_.back().vertex];
  eye_.back().delta = false;
  const std::optional<EmitterPoint> e = emitter_at(measure_.scene(), last.v);
  if (e) last.emitter = *e;
  return e.has_value();
}

bool PathBuilder::connect(WholePath& path) {
  if (!light_.empty() && vertex(eye_.back()).kind == Vertex::Kind::background) return false;
  eye_.back().delta = false;
  if (!light_.empty()) light_.back().delta = false;
  if (measure_.camera().parallel() && eye_.size() == 1) {
    const Vertex& seen = vertex(light_.back());
    if (seen.kind == Vertex::Kind::background) return false;
    pool_[eye_.front().vertex].v.surface.x = measure_.camera().eye(seen.surface.x);
  }
  path.nodes.assign(eye_.begin(), eye_.end());
  path.nodes.insert(path.nodes.end(), light_.rbegin(), light_.rend());
  return true;
}

bool PathBuilder::visible() const {
  if (light_.empty()) return true;
  const NodePlace a{pool_[eye_.back().vertex]}, b{pool_[light_.back().vertex]};
  ++counters_.shadow_rays;
  return !measure_.scene().rays().occluded(shadow_ray(a, b, edge_between(a, b)));
}

void PathBuilder::abandon() {
  const auto give_back = [&](std::vector<PathNode>& end, std::size_t kept) {
    for (std::size_t i = kept; i < end.size(); ++i) pool_.give_back(end[i].vertex);
    end.resize(std::min(kept, end.size()));
  };
  give_back(eye_, kept_eye_);
  give_back(light_, kept_light_);
}

}  // namespace lacuna
