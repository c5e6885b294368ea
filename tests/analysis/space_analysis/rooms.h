#pragma once

#include "analysis/geometry/triangle_soup.h"

namespace lacuna::test {

inline void add_wall(TriangleSoup& soup, Imath::V3f corner, Imath::V3f u, Imath::V3f v) {
  const auto i = static_cast<std::uint32_t>(soup.positions.size());
  for (const Imath::V3f& p : {corner, corner + u, corner + u + v, corner + v}) {
    soup.positions.push_back(p);
  }
  soup.triangles.push_back({i, i + 1, i + 2});
  soup.triangles.push_back({i, i + 2, i + 3});
}

/// A closed box from the origin.
inline TriangleSoup box(Imath::V3f size) {
  using Imath::V3f;
  TriangleSoup soup;
  const V3f x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  for (const V3f& far : {V3f(0), z}) add_wall(soup, far, x, y);
  for (const V3f& far : {V3f(0), y}) add_wall(soup, far, x, z);
  for (const V3f& far : {V3f(0), x}) add_wall(soup, far, y, z);
  return soup;
}

/// Two rooms of 4 x 4 x 3, a wall with a door between them; and a closet that nothing leads into.
inline TriangleSoup two_rooms() {
  using Imath::V3f;
  TriangleSoup soup = box({10, 4, 3});
  const V3f y(0, 1, 0), z(0, 0, 1);
  add_wall(soup, {8, 0, 0}, y * 4.0F, z * 3.0F);
  add_wall(soup, {4, 0, 0}, y * 1.5F, z * 3.0F);
  add_wall(soup, {4, 2.5F, 0}, y * 1.5F, z * 3.0F);
  add_wall(soup, {4, 1.5F, 2}, y, z);
  return soup;
}

}  // namespace lacuna::test
