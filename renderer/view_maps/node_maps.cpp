#include "renderer/view_maps/node_maps.h"

#include <fmt/format.h>

#include "analysis/geometry/simd.h"
#include "analysis/space/memory_limit.h"
#include "renderer/view_maps/nearness.h"

namespace lacuna {

namespace {

constexpr int least_size = 8, most_size = 1024;

/// A direction as a point on the cube around it.
struct CubePoint {
  int face;     // numbered as in NodeMaps::texels
  float u, v;   // in [-1, 1]
  float depth;  // along the face's axis

  explicit CubePoint(const V3f& d) {
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (std::abs(d[k]) > std::abs(d[axis])) axis = k;
    }
    face = 2 * axis + (d[axis] < 0 ? 1 : 0);
    depth = std::abs(d[axis]);
    u = d[(axis + 1) % 3] / depth;
    v = d[(axis + 2) % 3] / depth;
  }
};

/// The direction through (u, v) of a face, of length 1 along its axis.
V3f direction(int face, float u, float v) {
  const int axis = face / 2;
  V3f d;
  d[axis] = face % 2 == 1 ? -1.0F : 1.0F;
  d[(axis + 1) % 3] = u;
  d[(axis + 2) % 3] = v;
  return d;
}

/// The centre of texel `i` along a side, in [-1, 1]; `i` may lie outside the face.
float texel_centre(int i, int size) {
  return (2 * static_cast<float>(i) + 1) / static_cast<float>(size) - 1;
}

/// The interval of a row of texels that the filter covers.
struct Window {
  int first;
  float low, high;  // in texels, whose centres are integers

  Window(float at, int size, int filter) {
    const float centre = (at + 1) / 2 * static_cast<float>(size) - 0.5F;
    low = centre - static_cast<float>(filter) / 2;
    high = centre + static_cast<float>(filter) / 2;
    first = static_cast<int>(std::floor(low + 0.5F));
  }
  /// The covered fraction of texel `i`.
  float weight(int i) const {
    const auto x = static_cast<float>(i);
    return std::max(0.0F, std::min(x + 0.5F, high) - std::max(x - 0.5F, low));
  }
};

/// Sums over texels compared with a plane. Texels whose direction does not intersect the plane are
/// skipped.
struct Sums {
  float visible = 0, all = 0;
};

}  // namespace

NodeMaps trace_node_maps(const Scene& scene, std::span<const V3f> points, int size,
                         const ThreadPool& pool, std::uint64_t byte_limit) {
  NodeMaps maps;
  maps.size = size;
  const auto nearness = Nearness::within(static_cast<float>(2 * scene.bounds().radius()));
  maps.scale = nearness.scale;
  const std::size_t texels = points.size() * maps.texels_of_point() + NodeMaps::margin;
  if (const std::uint64_t bytes = texels * sizeof(maps.texels[0]); bytes > byte_limit) {
    throw MemoryLimitError(
        fmt::format("distance maps of {} nodes with {} x {} texels per face need {} bytes, "
                    "available are {}; lower map_size, or the resolution of the analysis",
                    points.size(), size, size, bytes, byte_limit));
  }
  maps.texels.resize(texels);
  const auto n = static_cast<std::size_t>(size);
  pool.for_each(static_cast<int>(points.size()) * NodeMaps::faces, [&](int part) {
    const V3f& from = points[static_cast<std::size_t>(part / NodeMaps::faces)];
    std::uint16_t* texel = maps.texels.data() + static_cast<std::size_t>(part) * n * n;
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i, ++texel) {
        const Ray ray{
            from, direction(part % NodeMaps::faces, texel_centre(i, size), texel_centre(j, size))};
        Hit hit;
        if (!scene.rays().intersect(ray, hit)) continue;
        *texel = nearness.encode(hit.t);
      }
    }
  });
  return maps;
}

namespace {

/// Evaluates a node's map around a direction.
class Comparison {
 public:
  /// The plane: points p with p . n = h, relative to the node. `over_h`: maps.scale / h, increased
  /// so that points slightly in front of the plane count as on it.
  Comparison(const NodeMaps& maps, std::size_t index, const V3f& n, float over_h)
      : maps_(maps),
        texels_(maps.texels.data() + index * maps.texels_of_point()),
        n_(n),
        over_h_(over_h) {}

  /// The visible fraction of the plane around direction `d`.
  float share(const V3f& d, int filter) const {
    const Sums sums = around(CubePoint(d), filter);
    return sums.all > 0 ? sums.visible / sums.all : 0;
  }

 private:
  Sums around(const CubePoint& p, int filter) const {
    const Window across(p.u, maps_.size, filter), down(p.v, maps_.size, filter);
    const auto inside = [&](int first) { return first >= 0 && first + filter < maps_.size; };
    if (inside(across.first) && inside(down.first)) return rows(p.face, across, down, filter);
    Sums sums;
    for (int j = down.first; j <= down.first + filter; ++j) {
      for (int i = across.first; i <= across.first + filter; ++i) {
        add(direction(p.face, texel_centre(i, maps_.size), texel_centre(j, maps_.size)),
            across.weight(i) * down.weight(j), sums);
      }
    }
    return sums;
  }

  const std::uint16_t* texel(int face, int i, int j) const {
    const auto n = static_cast<std::size_t>(maps_.size);
    return texels_ + (static_cast<std::size_t>(face) * n + static_cast<std::size_t>(j)) * n +
           static_cast<std::size_t>(i);
  }

  /// A square within a face, up to eight texels of a row at once.
  Sums rows(int face, const Window& across, const Window& down, int filter) const {
    alignas(32) static constexpr std::array<float, 8> steps{0, 1, 2, 3, 4, 5, 6, 7};
    const Float8 column = Float8::load(steps.data()) + static_cast<float>(across.first);
    const Float8 weight =
        max(0.0F, min(column + 0.5F, across.high) - max(column - 0.5F, across.low));
    // 1 / depth of the plane is linear on a face.
    const V3f start = direction(face, texel_centre(across.first, maps_.size), 0);
    const float du = 2 / static_cast<float>(maps_.size) * n_[(face / 2 + 1) % 3] * over_h_;
    const Float8 first = Float8::load(steps.data()) * du + start.dot(n_) * over_h_;
    Float8 visible = 0.0F, all = 0.0F;
    for (int j = down.first; j <= down.first + filter; ++j) {
      const Float8 plane = first + texel_centre(j, maps_.size) * n_[(face / 2 + 2) % 3] * over_h_;
      const Float8 nearest = Float8::load_half(texel(face, across.first, j));
      const Float8 counts = keep_where(plane > 0, weight * down.weight(j));
      all = all + counts;
      visible = visible + keep_where(plane >= nearest, counts);
    }
    return {reduce_add(visible), reduce_add(all)};
  }

  /// Adds one texel in a direction that may lie beyond the face for which it was computed.
  void add(const V3f& d, float weight, Sums& sums) const {
    const CubePoint p(d);
    const auto place = [&](float at) {
      const auto i = static_cast<int>((at + 1) / 2 * static_cast<float>(maps_.size));
      return std::clamp(i, 0, maps_.size - 1);
    };
    const float plane = d.dot(n_) * over_h_ / p.depth;
    if (!(plane > 0)) return;
    sums.all += weight;
    if (plane >= Nearness::decode(*texel(p.face, place(p.u), place(p.v)))) sums.visible += weight;
  }

  const NodeMaps& maps_;
  const std::uint16_t* texels_;
  V3f n_;
  float over_h_;
};

}  // namespace

float NodeView::visible_fraction(const V3f& x, const V3f& n) const {
  const V3f d = x - point_;
  const float h = d.dot(n);
  if (!(h < 0)) return 0;  // the node lies behind the surface
  // Increased by half a texel's width: points closer to the plane than that count as on it.
  const float over_h = maps_->scale * (1 + 1 / static_cast<float>(maps_->size)) / h;
  return Comparison(*maps_, index_, n, over_h).share(d, filter_);
}

float NodeView::visible_fraction(const V3f& x) const {
  const V3f d = x - point_;
  return d == V3f(0.0F) ? 1.0F : visible_fraction(x, -d.normalized());
}

float NodeView::open(const V3f& w) const {
  // A plane beyond every nonzero texel: these are at least 6e-8 (Nearness).
  constexpr float over_h = -1e-20F;
  return Comparison(*maps_, index_, -w, over_h).share(w, filter_);
}

void Codec<NodeMaps>::write(ArtefactWriter& out, const NodeMaps& maps) {
  encode(out, maps.size, maps.scale, maps.texels);
}

NodeMaps Codec<NodeMaps>::read(ArtefactReader& in) {
  NodeMaps maps;
  maps.size = decode<int>(in);
  require(maps.size >= least_size && maps.size <= most_size, "a side has 8 to 1024 texels");
  maps.scale = decode<float>(in);
  require(maps.scale > 0 && maps.scale <= std::numeric_limits<float>::max(),
          "the scale is above 0");
  maps.texels = decode<std::vector<std::uint16_t>>(in);
  require(maps.texels.size() >= NodeMaps::margin &&
              (maps.texels.size() - NodeMaps::margin) % maps.texels_of_point() == 0,
          "whole maps");
  return maps;
}

}  // namespace lacuna
