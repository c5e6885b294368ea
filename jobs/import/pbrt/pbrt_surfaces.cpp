#include "jobs/import/pbrt/pbrt_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "jobs/import/mesh_normals.h"
#include "jobs/import/pbrt/pbrt_shapes.h"

namespace lacuna::pbrt {
namespace {

constexpr std::size_t max_made_triangles = std::size_t{1} << 24;  // of one shape
constexpr double max_of_many_levels = 1 << 16;                    // of more than four subdivisions

using Triangle = std::array<std::uint32_t, 3>;

/// A patch p(u, v) of four corners: (0, 0), (1, 0), (0, 1), (1, 1).
struct Patch {
  std::array<V3d, 4> p;

  V3d at(double u, double v) const { return mix(p, u, v); }
  V3d normal(double u, double v) const {
    const V3d du = (p[1] - p[0]) * (1 - v) + (p[3] - p[2]) * v;
    const V3d dv = (p[2] - p[0]) * (1 - u) + (p[3] - p[1]) * u;
    return du.cross(dv);
  }
  double size() const { return std::max((p[3] - p[0]).length(), (p[2] - p[1]).length()); }
  bool is_parallelogram() const { return (p[0] + p[3] - p[1] - p[2]).length() <= 1e-6 * size(); }
  bool is_flat() const {
    const double s = size();
    return std::abs((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0])) <= 1e-6 * s * s * s;
  }
  template <class T>
  static T mix(const std::array<T, 4>& c, double u, double v) {
    return (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[2] * (1 - u) + c[3] * u) * v;
  }
};

/// A vertex's neighbours in a triangle mesh, and whether it lies on the border.
struct Ring {
  std::vector<std::uint32_t> all, border;
};

std::vector<Ring> rings_of(const std::vector<Triangle>& triangles, std::size_t vertices) {
  std::map<std::array<std::uint32_t, 2>, int> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++edges[{std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])}];
    }
  }
  std::vector<Ring> out(vertices);
  for (const auto& [e, count] : edges) {
    for (std::size_t i = 0; i < 2; ++i) {
      out[e[i]].all.push_back(e[1 - i]);
      if (count == 1) out[e[i]].border.push_back(e[1 - i]);
    }
  }
  return out;
}

/// p (1 - n w) + w times the sum of n neighbours.
V3d weighted(const std::vector<V3d>& points, std::uint32_t vertex,
             const std::vector<std::uint32_t>& neighbours, double w) {
  V3d sum(0, 0, 0);
  for (const std::uint32_t n : neighbours) sum += points[n];
  return points[vertex] * (1 - w * static_cast<double>(neighbours.size())) + sum * w;
}

/// Warren's weights of a neighbour for Loop's scheme.
double loop_weight(std::size_t valence) {
  return valence == 3 ? 3.0 / 16 : 3.0 / (8 * static_cast<double>(valence));
}

/// One step of Loop's scheme (Loop 1987; borders as cubic B-splines).
void subdivide(std::vector<V3d>& points, std::vector<Triangle>& triangles) {
  const std::vector<Ring> rings = rings_of(triangles, points.size());
  std::vector<V3d> next(points.size());
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    const Ring& r = rings[v];
    next[v] = r.all.empty()      ? points[v]
              : r.border.empty() ? weighted(points, v, r.all, loop_weight(r.all.size()))
                                 : weighted(points, v, r.border, 1.0 / 8);
  }
  struct Edge {
    std::uint32_t index = 0;
    V3d opposite{0, 0, 0};
    int triangles = 0;
  };
  std::map<std::array<std::uint32_t, 2>, Edge> edges;
  const auto edge = [&](const Triangle& t, std::size_t i) -> Edge& {
    return edges[{std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])}];
  };
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      edge(t, i).opposite += points[t[(i + 2) % 3]];
      ++edge(t, i).triangles;
    }
  }
  for (auto& [ends, e] : edges) {
    const V3d sum = points[ends[0]] + points[ends[1]];
    e.index = static_cast<std::uint32_t>(next.size());
    next.push_back(e.triangles == 2 ? sum * (3.0 / 8) + e.opposite * (1.0 / 8) : sum * 0.5);
  }
  std::vector<Triangle> fine;
  fine.reserve(4 * triangles.size());
  for (const Triangle& t : triangles) {
    const Triangle m{edge(t, 0).index, edge(t, 1).index, edge(t, 2).index};
    for (std::size_t i = 0; i < 3; ++i) fine.push_back({t[i], m[i], m[(i + 2) % 3]});
    fine.push_back(m);
  }
  points = std::move(next);
  triangles = std::move(fine);
}

/// The positions that infinitely many steps lead to.
std::vector<V3d> limit_of(const std::vector<V3d>& points, const std::vector<Triangle>& triangles) {
  const std::vector<Ring> rings = rings_of(triangles, points.size());
  std::vector<V3d> out(points.size());
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    const Ring& r = rings[v];
    const auto n = static_cast<double>(r.all.size());
    out[v] = r.all.empty() ? points[v]
             : r.border.empty()
                 ? weighted(points, v, r.all, 1 / (n + 3 / (8 * loop_weight(r.all.size()))))
                 : weighted(points, v, r.border, 1.0 / 5);
  }
  return out;
}

}  // namespace

std::shared_ptr<const ImportedMesh> bilinear_mesh(Context& context, const Parameters& p) {
  ImportedMesh in;
  read_vertices(p, in);
  auto indices = p.indices("indices", 4, in.positions.size());
  if (indices.empty() && in.positions.size() == 4) indices = {0, 1, 2, 3};
  if (indices.empty()) fail(p.place(), fmt::format("{}: \"indices\" is missing", p.owner()));
  if (p.find("emissionfilename", {"string"}) != nullptr) {
    context.left_out(p.place(), p.owner(), "the picture of the emission");
  }
  p.ignore({"faceIndices"});
  const auto out = std::make_shared<ImportedMesh>();
  out->name = "bilinearmesh";
  for (std::size_t i = 0; i < indices.size(); i += 4) {
    Patch patch;
    std::array<V2d, 4> uv{V2d(0, 0), V2d(1, 0), V2d(0, 1), V2d(1, 1)};
    std::array<V3d, 4> normals;
    for (std::size_t c = 0; c < 4; ++c) {
      patch.p[c] = V3d(in.positions[indices[i + c]]);
      if (!in.uvs.empty()) uv[c] = V2d(in.uvs[indices[i + c]]);
      if (!in.normals.empty()) normals[c] = V3d(in.normals[indices[i + c]]);
    }
    if (!patch.is_flat()) {
      context.approximated(p.place(), p.owner(), "a curved patch as 8 x 8 squares of triangles");
    }
    const std::uint32_t steps = patch.is_parallelogram() ? 1 : 8;
    const auto first = static_cast<std::uint32_t>(out->positions.size());
    for (std::uint32_t y = 0; y <= steps; ++y) {
      for (std::uint32_t x = 0; x <= steps; ++x) {
        const double u = double(x) / steps, v = double(y) / steps;
        out->positions.emplace_back(patch.at(u, v));
        out->uvs.emplace_back(Patch::mix(uv, u, v));
        out->normals.emplace_back(
            (in.normals.empty() ? patch.normal(u, v) : Patch::mix(normals, u, v)).normalized());
        if (x == steps || y == steps) continue;
        const std::uint32_t a = first + y * (steps + 1) + x, b = a + steps + 1;
        out->triangles.push_back({a, a + 1, b + 1});
        out->triangles.push_back({a, b + 1, b});
      }
    }
    if (out->triangles.size() > max_made_triangles) {
      fail(p.place(), fmt::format("{}: more than {} triangles", p.owner(), max_made_triangles));
    }
  }
  orient_by_normals(*out);
  return out;
}

std::shared_ptr<const ImportedMesh> loop_subdivision(Context& context, const Parameters& p) {
  ImportedMesh in;
  read_vertices(p, in);
  p.ignore({"scheme"});
  const auto indices = p.indices("indices", 3, in.positions.size());
  if (indices.empty()) fail(p.place(), fmt::format("{}: \"indices\" is missing", p.owner()));
  const int stated = p.integer("levels", p.integer("nlevels", 3, 0, 64), 0, 64);
  // A small file is not to make a large mesh: few levels, or few triangles.
  const auto size = [&](int levels) {
    return static_cast<double>(indices.size() / 3) * std::pow(4.0, levels);
  };
  int levels = stated;
  while (levels > 4 && size(levels) > max_of_many_levels) --levels;
  if (size(levels) > static_cast<double>(max_made_triangles)) {
    fail(p.place(), fmt::format("{}: {} triangles after {} levels; allowed: up to {}", p.owner(),
                                size(levels), levels, max_made_triangles));
  }
  if (levels < stated) {
    context.approximated(p.place(), p.owner(), fmt::format("{} of {} levels", levels, stated));
  }
  std::vector<V3d> points(in.positions.begin(), in.positions.end());
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  for (int i = 0; i < levels; ++i) subdivide(points, triangles);
  points = limit_of(points, triangles);
  const auto out = std::make_shared<ImportedMesh>();
  out->name = "loopsubdiv";
  out->positions.assign(points.begin(), points.end());
  out->triangles = std::move(triangles);
  add_smooth_normals(*out);
  context.approximated(
      p.place(), p.owner(),
      fmt::format("the surface's limit at {} levels, normals of the triangles", levels));
  return out;
}

}  // namespace lacuna::pbrt
