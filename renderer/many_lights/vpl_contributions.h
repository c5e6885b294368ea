#pragma once

#include "renderer/many_lights/vpl_set.h"
#include "renderer/materials/bsdf_seen.h"
#include "renderer/path/bsdf_guide.h"
#include "renderer/path/connect.h"

namespace lacuna {

/// What `bound` leaves of the geometric term `g` >= 0, as a share.
inline float bounded_share(float g, float bound) { return g > bound ? bound / g : 1.0F; }

/// A place of the picture that virtual lights shine on: the first vertex of an eye path that is
/// broad enough (Bsdf::is_vpl_receiver()), and so opaque.
struct ShadingPoint {
  const Vertex* vertex = nullptr;
  int depth = 0;   ///< edges from the eye
  int edges = -1;  ///< of lights that may shine on it, at most; < 0: none
  std::uint32_t pixel = 0;
  BsdfSeen seen;    ///< its factor is the path's throughput
  float scale = 0;  ///< luminance of throughput times albedo, which contributions grow with

  ShadingPoint(const Vertex& v, int edges_from_eye, int most_edges, std::uint32_t at)
      : vertex(&v),
        depth(edges_from_eye),
        edges(most_edges),
        pixel(at),
        seen(*v.bsdf, v.wp),
        scale(luminance(v.throughput * v.bsdf->albedo())) {
    seen.factor *= v.throughput;
  }
};

/// Where up to sixty-four shading points lie, side by side.
class PointLanes {
 public:
  void add(const ShadingPoint& p);
  /// Bit i: there is a point i.
  std::uint64_t all() const {
    return size_ < 64 ? (std::uint64_t{1} << size_) - 1 : ~std::uint64_t{0};
  }
  /// Bit i: lights within the bounds may shine on point i. To the others they turn their backs, or
  /// they lie behind them.
  std::uint64_t may_be_lit(const BlockBounds& bounds) const;
  /// Bit i: a light within the bounds may lie within `distance` of point i.
  std::uint64_t may_be_near(const BlockBounds& bounds, float distance) const;

 private:
  /// All but those of which `leaves_out(x, n)` tells eight at a time.
  template <class LeavesOut>
  std::uint64_t all_but(LeavesOut&& leaves_out) const;

  std::size_t size_ = 0;
  Lanes x_, y_, z_;
  Lanes nx_, ny_, nz_;  // the geometric normal, on the side that is seen
};

/// What the lights of a block give to a shading point if nothing lies between: t_i of Nabata et
/// al., section 2.2.
struct Terms {
  Lanes r, g, b;
  Lanes luminance;
  std::uint64_t lit = 0;       ///< those that are not black
  std::uint64_t rejected = 0;  ///< those that were not finite; black now
};

/// The contributions of virtual lights, with the geometric term bounded.
class VplContributions {
 public:
  /// `bound`: of the geometric term, 1 / scene units^2; may be infinite.
  VplContributions(const VplSet& lights, float bound) : lights_(lights), bound_(bound) {}

  const VplSet& lights() const { return lights_; }
  /// Of the light that goes straight between two surfaces the share that the bound leaves.
  float share(const Vertex& a, const Vertex& b, const V3f& w) const {
    const float cosines = abs_dot(a.surface.ng, w) * abs_dot(b.surface.ng, w);
    return bounded_share(cosines / (a.surface.x - b.surface.x).length2(), bound_);
  }
  /// Bit i: lights of the block may give something to point i. To the others evaluate() would give
  /// nothing, and is saved.
  std::uint64_t may_light(std::size_t block, const PointLanes& points) const {
    return lights_.diffuse(block) == nullptr ? points.all()
                                             : points.may_be_lit(lights_.bounds(block));
  }
  static constexpr std::uint64_t all_lights = ~std::uint64_t{0};
  /// Those of the lights in `of`, times `weight`; the others are black.
  void evaluate(const ShadingPoint& at, std::size_t block, Terms& out,
                std::uint64_t of = all_lights, float weight = 1) const;
  /// The ray that asks whether light `i` of `block`, which is lit, and `at` see one another.
  Ray ray(const ShadingPoint& at, std::size_t block, int i) const;

 private:
  void diffuse_terms(const ShadingPoint& at, const DiffuseBlock& from, std::uint64_t of,
                     Terms& out) const;
  Rgb general(const ShadingPoint& at, const GeneralLight& light) const;
  static void weigh(std::uint64_t of, float weight, Terms& out);
  static void finish(Terms& out);

  const VplSet& lights_;
  float bound_;
  BsdfGuide guide_;
};

}  // namespace lacuna
