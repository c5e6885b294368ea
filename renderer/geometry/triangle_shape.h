#pragma once

#include <immintrin.h>

#include <array>

#include "renderer/geometry/rays.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// The geometry of a triangle, scene units.
struct TriangleShape {
  std::array<V3f, 3> corners{V3f(0, 0, 0), V3f(0, 0, 0), V3f(0, 0, 0)};
  V3f ng{0, 0, 0};  ///< unit, towards the front (counter-clockwise)
  /// Twice a bound on the error of Embree's distance between the plane and a point of the triangle.
  /// With u = 2^-24, the unit normal n, the sides E of the bounding box and the triangle's area A,
  /// the bound is u (E_x E_y E_z / 2A + sum_i |n_i| E_i): the rounding of the products of edges
  /// that make up the normal, and of the distances from the corners. It is 0 in a plane across an
  /// axis. tests/renderer/geometry measures at most 1.2 times the bound, for triangles of any
  /// shape.
  float plane_error = 0;

  TriangleShape() = default;
  explicit TriangleShape(const std::array<V3f, 3>& corners);
  TriangleShape(const Mesh& mesh, std::uint32_t triangle);
  /// The triangle of `shape` as an instance places it, in scene coordinates. Its plane_error
  /// includes what Embree's transform of rays adds.
  TriangleShape(const TriangleShape& shape, const Instance& instance);
  /// Barycentric (u, v), as in Hit, of the point `x` in its plane.
  V2f barycentric(const V3f& x) const;
  double area() const { return normal().length() / 2; }
  V3d edge(std::size_t to) const { return V3d(corners[to]) - V3d(corners[0]); }
  /// The normal, not unit: its length is twice the area.
  V3d normal() const { return edge(1).cross(edge(2)); }
  /// The point at barycentric (u, v). In double: only the last rounding moves it off the plane.
  V3f at(float u, float v) const {
    // The corners and ng are contiguous: the fourth lane of each load holds a neighbour's value,
    // which is ignored.
    const __m256d p = load(corners[0]);
    const __m256d e1 = _mm256_sub_pd(load(corners[1]), p);
    const __m256d e2 = _mm256_sub_pd(load(corners[2]), p);
    const __m256d x = _mm256_add_pd(_mm256_add_pd(p, _mm256_mul_pd(_mm256_set1_pd(double(u)), e1)),
                                    _mm256_mul_pd(_mm256_set1_pd(double(v)), e2));
    const __m128 rounded = _mm256_cvtpd_ps(x);
    V3f result;
    _mm_storel_pi(reinterpret_cast<__m64*>(&result.x), rounded);
    _mm_store_ss(&result.z, _mm_movehl_ps(rounded, rounded));
    return result;
  }
  /// The point where `ray` hits the plane, near barycentric (u, v), which are accurate only to
  /// 2^-24 of the triangle's size.
  V3f at(const Ray& ray, float u, float v) const;

 private:
  static __m256d load(const V3f& p) { return _mm256_cvtps_pd(_mm_loadu_ps(&p.x)); }
};

inline V3f TriangleShape::at(const Ray& ray, float u, float v) const {
  const V3d p(corners[0]), e1 = edge(1), e2 = edge(2), n = e1.cross(e2), d(ray.d);
  const V3d by_corners = p + e1 * double(u) + e2 * double(v);
  const V3d on_ray = V3d(ray.o) + d * ((p - V3d(ray.o)).dot(n) / d.dot(n));
  const V3d step = on_ray - by_corners;
  // A ray in the plane does not intersect it, and a nearly parallel one intersects it far away.
  constexpr double resolution2 = 0x1p-40;
  if (!(step.length2() <= std::max(e1.length2(), e2.length2()) * resolution2)) {
    return V3f(by_corners);
  }
  // A combination of edges, so that it stays in the plane.
  const V3d scaled = n / n.length2();
  return V3f(p + e1 * (double(u) + step.cross(e2).dot(scaled)) +
             e2 * (double(v) + e1.cross(step).dot(scaled)));
}

}  // namespace lacuna
