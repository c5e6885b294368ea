#include "renderer/mutations/path_measure.h"

#include "renderer/path/connect.h"

namespace lacuna {
namespace {

/// The edge between x_i and x_{i+1}; false if they coincide. `parallel`: x_i is the eye of a
/// parallel projection, whose densities are per area whatever the edge's length.
bool make_edge(const Vertex& near_eye, const PathVertex& near_light, bool last, bool parallel,
               PathEdge& edge) {
  Connection c = edge_between(VertexPlace{near_eye}, VertexPlace{near_light.v});
  if (!(c.distance2 > 0)) return false;
  if (parallel) c.distance2 = 1;
  edge.w = c.w;
  // A point in space has no surface: its density is not per area.
  const bool surface = !last || near_light.emitter.kind == EmitterPoint::Kind::area;
  const float cosine = surface && near_light.v.kind != Vertex::Kind::background
                           ? abs_dot(near_light.v.surface.ng, edge.w)
                           : 1.0F;
  edge.to_light = cosine / c.distance2;
  edge.to_eye = near_eye.kind == Vertex::Kind::surface
                    ? abs_dot(near_eye.surface.ng, edge.w) / c.distance2
                    : 0.0F;
  return true;
}

/// The transmittance of the edge between x_i and x_{i+1}.
Rgb passed(const WholePath& path, const VertexPool& pool, int i) {
  const VertexPlace near_eye{pool[path.node(i).vertex].v},
      near_light{pool[path.node(i + 1).vertex].v};
  return transmittance(near_eye, near_light, edge_between(near_eye, near_light));
}

/// f |cos| at x_i, 0 < i < k, for radiance.
Rgb scattered(const WholePath& path, const VertexPool& pool, int i) {
  const PathNode& node = path.node(i);
  const Vertex& v = pool[node.vertex].v;
  const V3f wo = -path.edge(i - 1).w;
  if (!node.delta) return v.bsdf->eval(wo, path.edge(i).w, Transport::radiance);
  const auto lobe = v.bsdf->delta(wo, node.transmitted);
  return lobe ? lobe->value : Rgb(0, 0, 0);
}

bool can_connect(const WholePath& path, const VertexPool& pool, int j) {
  const int k = path.edge_count();
  if (j == k) return !pool[path.nodes.back().vertex].emitter.delta();
  return !path.node(j).delta && !path.node(j + 1).delta;
}

}  // namespace

PathMeasure::PathMeasure(const Scene& scene, const Camera& camera)
    : scene_(scene),
      camera_(camera),
      pixels_(static_cast<float>(camera.width()) * static_cast<float>(camera.height())),
      margin_(camera.margin()),
      film_size_(static_cast<float>(camera.width()) + 2 * margin_,
                 static_cast<float>(camera.height()) + 2 * margin_) {}

bool PathMeasure::evaluate(WholePath& path, const VertexPool& pool) const {
  const int k = path.edge_count();
  path.edges.resize(static_cast<std::size_t>(k));
  path.luminance = 0;
  for (int i = 0; i < k; ++i) {
    if (!make_edge(pool[path.node(i).vertex].v, pool[path.node(i + 1).vertex], i + 1 == k,
                   i == 0 && camera_.parallel(), path.edges[static_cast<std::size_t>(i)])) {
      return false;
    }
  }
  const V3f& first = path.edge(0).w;
  const std::optional<V2f> film = camera_.project(pool[path.node(0).vertex].v.surface.x, first);
  if (!film) return false;
  path.film = *film;
  long double scale =
      static_cast<long double>(camera_.density(first).value / pixels_) * path.edge(0).to_light;
  Rgb product = pool[path.nodes.back().vertex].emitter.towards(-path.edge(k - 1).w);
  const bool absorbs = scene_.has_media();
  if (absorbs) product *= passed(path, pool, 0);
  for (int i = 1; i < k; ++i) {
    product *= scattered(path, pool, i);
    if (absorbs) product *= passed(path, pool, i);
    const float largest = max_component(product);
    if (!(largest > 0)) return false;
    product /= largest;
    scale *= largest;
    scale *= path.edge(i).to_light;
  }
  const float y = luminance(product);
  if (!(y > 0) || !(scale > 0)) return false;
  path.colour = product / y;
  path.luminance = scale * y;
  return true;
}

double PathMeasure::from_eye(const WholePath& path, const VertexPool& pool, int i) const {
  const PathNode& node = path.node(i - 1);
  const PathEdge& edge = path.edge(i - 1);
  if (i == path.edge_count() && pool[path.node(i).vertex].emitter.delta()) return 0;
  double p = 0;
  if (i == 1) {
    p = double(camera_.density(edge.w).value) / (double(film_size_.x) * double(film_size_.y));
  } else {
    const V3f wo = -path.edge(i - 2).w;
    const Bsdf& bsdf = *pool[node.vertex].v.bsdf;
    if (node.delta) {
      const auto lobe = bsdf.delta(wo, node.transmitted);
      p = lobe ? lobe->p_radiance : 0.0;
    } else {
      p = double(bsdf.pdf(wo, edge.w, Transport::radiance).value);
    }
  }
  return p * double(edge.to_light);
}

double PathMeasure::from_light(const WholePath& path, const VertexPool& pool, int i) const {
  const int k = path.edge_count();
  const EmitterPoint& emitter = pool[path.nodes.back().vertex].emitter;
  if (i == k) return double(emitter.pdf.value);
  const PathEdge& edge = path.edge(i);
  double p = 0;
  if (i + 1 == k) {
    p = double(emitter.pdf_Le(-edge.w).value);
  } else {
    const PathNode& node = path.node(i + 1);
    const Bsdf& bsdf = *pool[node.vertex].v.bsdf;
    if (node.delta) {
      const auto lobe = bsdf.delta(-edge.w, node.transmitted);
      p = lobe ? lobe->p_importance : 0.0;
    } else {
      p = double(bsdf.pdf(path.edge(i + 1).w, -edge.w, Transport::importance).value);
    }
  }
  return p * double(edge.to_eye);
}

double PathMeasure::per_direction_from_eye(const WholePath& path, const VertexPool& pool,
                                           int i) const {
  if (i == path.edge_count() && pool[path.node(i).vertex].emitter.delta()) return 0;
  const PathEdge& edge = path.edge(i - 1);
  return (i == 1 ? double(camera_.density(edge.w).value) : 1.0) * double(edge.to_light);
}

double PathMeasure::per_direction_from_light(const WholePath& path, const VertexPool& pool,
                                             int i) const {
  const PathEdge& edge = path.edge(i);
  const PathNode& node = path.node(i + 1);
  if (!node.delta) return double(edge.to_eye);
  const auto lobe = pool[node.vertex].v.bsdf->delta(-edge.w, node.transmitted);
  return lobe ? lobe->jacobian * double(edge.to_eye) : 0.0;
}

long double PathMeasure::between(const WholePath& path, const VertexPool& pool, int first,
                                 int last) const {
  long double lights = 1;  // density of sampling x_j ... x_{last-1} from the light
  long double sum = can_connect(path, pool, last - 1) ? 1 : 0;
  for (int j = last - 1; j > first; --j) {
    lights *= from_light(path, pool, j);
    sum *= from_eye(path, pool, j);
    if (can_connect(path, pool, j - 1)) sum += lights;
  }
  return sum;
}

}  // namespace lacuna
