#pragma once

#include "renderer/many_lights/vpl_set.h"
#include "renderer/materials/bsdf_at_wo.h"
#include "renderer/path/connect.h"
#include "renderer/path/guide.h"

namespace lacuna {

/// min(g, bound) / g, for a geometric term `g` >= 0.
inline float bounded_share(float g, float bound) { return g > bound ? bound / g : 1.0F; }

/// A point that gathers virtual lights: the first vertex of an eye path for which
/// Bsdf::is_vpl_receiver() holds; it is therefore opaque.
struct ShadingPoint {
  const Vertex* vertex = nullptr;
  int depth = 0;   ///< edges from the eye
  int edges = -1;  ///< largest number of edges of the lights' paths; < 0: no lights
  std::uint32_t pixel = 0;
  BsdfAtWo bsdf;    ///< its factor is the path's throughput
  float scale = 0;  ///< luminance of throughput times albedo: contributions are proportional to it

  ShadingPoint(const Vertex& v, int edges_from_eye, int most_edges, std::uint32_t at)
      : vertex(&v),
        depth(edges_from_eye),
        edges(most_edges),
        pixel(at),
        bsdf(*v.bsdf, v.wp),
        scale(luminance(v.throughput * v.bsdf->albedo())) {
    bsdf.factor *= v.throughput;
  }
};

/// Positions and normals of up to sixty-four shading points, as a structure of arrays.
class PointLanes {
 public:
  void add(const ShadingPoint& p);
  std::size_t size() const { return size_; }
  /// Positions, and normals on the side of the eye, of points 8 `group` to 8 `group` + 7.
  Float8x3 x(int group) const { return {x_.eight(group), y_.eight(group), z_.eight(group)}; }
  Float8x3 n(int group) const { return {nx_.eight(group), ny_.eight(group), nz_.eight(group)}; }
  /// A mask of all points.
  std::uint64_t all() const {
    return size_ < 64 ? (std::uint64_t{1} << size_) - 1 : ~std::uint64_t{0};
  }
  /// A mask of the points that lights within the bounds may illuminate. The lights face away from
  /// the other points or lie behind their surfaces.
  std::uint64_t may_be_lit(const BlockBounds& bounds) const;
  /// A mask of the points that may be within `distance` of a light within the bounds.
  std::uint64_t may_be_near(const BlockBounds& bounds, float distance) const;

 private:
  /// A mask of the points for which `leaves_out(x, n)`, evaluated for eight points at a time, is
  /// false.
  template <class LeavesOut>
  std::uint64_t all_but(LeavesOut&& leaves_out) const;

  std::size_t size_ = 0;
  Lanes x_, y_, z_;
  Lanes nx_, ny_, nz_;  // geometric normal on the side of the eye
};

/// The unoccluded contributions of a block's lights to a shading point: t_i of Nabata et al.,
/// section 2.2.
struct Terms {
  Lanes r, g, b;
  Lanes luminance;
  std::uint64_t lit = 0;       ///< mask of the lights that are not black
  std::uint64_t rejected = 0;  ///< mask of contributions that were not finite and were set to black
  float weight = 1;  ///< factor of all contributions: 1 / the probability of sampling a light
};

/// Evaluates the contributions of virtual lights with a bounded geometric term.
class VplContributions {
 public:
  /// `bound` of the geometric term, 1 / scene units^2; may be infinite.
  VplContributions(const VplSet& lights, float bound) : lights_(lights), bound_(bound) {}

  const VplSet& lights() const { return lights_; }
  /// The bound of the geometric term.
  float bound() const { return bound_; }
  /// min(G, bound) / G, for the geometric term G of two surfaces with direction `w` between them.
  float share(const Vertex& a, const Vertex& b, const V3f& w) const {
    const float cosines = abs_dot(a.surface.ng, w) * abs_dot(b.surface.ng, w);
    return bounded_share(cosines / (a.surface.x - b.surface.x).length2(), bound_);
  }
  /// A mask of the points that lights of the block may illuminate. For other points evaluate()
  /// returns black and need not be called.
  std::uint64_t may_light(std::size_t block, const PointLanes& points) const {
    return lights_.diffuse(block) == nullptr ? points.all()
                                             : points.may_be_lit(lights_.bounds(block));
  }
  static constexpr std::uint64_t all_lights = ~std::uint64_t{0};
  /// Evaluates the lights in the mask `of`, times `weight`; the others are black.
  void evaluate(const ShadingPoint& at, std::size_t block, Terms& out,
                std::uint64_t of = all_lights, float weight = 1) const;
  /// The shadow ray between light `i` of `block`, which is lit, and `at`.
  Ray ray(const ShadingPoint& at, std::size_t block, int i) const;
  /// The same for a light that may not be lit: the ray starts on the side of `at` that faces the
  /// eye and ends on the emitting side of the light. If one lies behind the other's horizon, its
  /// surface occludes the ray.
  Ray ray_from_side(const ShadingPoint& at, std::size_t block, int i) const;

 private:
  void diffuse_terms(const ShadingPoint& at, const DiffuseBlock& from, std::uint64_t of,
                     Terms& out) const;
  Rgb general(const ShadingPoint& at, const GeneralLight& light) const;
  static void weigh(std::uint64_t of, float weight, Terms& out);
  static void finish(Terms& out);

  const VplSet& lights_;
  float bound_;
  Guide guide_;
};

}  // namespace lacuna
